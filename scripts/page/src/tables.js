// Tables whose columns sort them.

const number = (text) => {
  const found = text.replace(/−/g, "-").match(/-?[\d.]+(?:e[-+]?\d+)?/i);
  return found ? parseFloat(found[0]) : NaN;
};

function compare(a, b) {
  const x = number(a), y = number(b);
  if (Number.isNaN(x) || Number.isNaN(y)) return a.localeCompare(b, "en");
  return x - y;
}

function sort(table, column, head) {
  const descending = head.getAttribute("aria-sort") === "ascending";
  for (const other of table.tHead.rows[0].cells) other.removeAttribute("aria-sort");
  head.setAttribute("aria-sort", descending ? "descending" : "ascending");
  const text = (row) => row.cells[column].dataset.value ?? row.cells[column].textContent.trim();
  const rows = [...table.tBodies[0].rows].sort((a, b) => compare(text(a), text(b)) * (descending ? -1 : 1));
  table.tBodies[0].append(...rows);
}

/** Makes buttons of the heads of all tables of class "sortable". */
export function makeSortable(root) {
  for (const table of root.querySelectorAll("table.sortable"))
    [...table.tHead.rows[0].cells].forEach((head, column) => {
      if (!head.textContent.trim()) return;
      const button = document.createElement("button");
      button.type = "button";
      button.append(...head.childNodes);
      button.addEventListener("click", () => sort(table, column, head));
      head.append(button);
    });
}
