"""Settings of Sphinx for the site of documents and interface; make.py stages the sources and sets the paths."""
import os
import re
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from citations import ROOT  # noqa: E402  (found through the line above)

project = "elastogear"
version = release = re.search(r"project\(elastogear VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")).group(1)
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.graphviz", "sphinx.ext.mathjax", "links", "equations",
              "code_pages", "docstrings", "diagram", "accessible"]
highlight_language = "none"
primary_domain = "cpp"
add_module_names = False
toc_object_entries_show_parents = "hide"

autodoc_default_options = {"members": True, "inherited-members": "object,int,float,dict", "undoc-members": True, "member-order": "bysource"}
autodoc_typehints = "signature"
autodoc_preserve_defaults = True

myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 4
myst_url_schemes = ["http", "https", "code"]
mathjax_path = "mathjax/MathJax.js?config=TeX-AMS_CHTML"
mathjax_options = {"defer": "defer"}
mathjax2_config = {"showMathMenu": False, "messageStyle": "none",
                   "tex2jax": {"inlineMath": [["\\(", "\\)"]], "processClass": "math", "ignoreClass": "document"}}

html_theme = "alabaster"
html_theme_options = {"fixed_sidebar": True, "page_width": "1240px", "sidebar_width": "230px", "show_powered_by": False, "body_text_align": "left",
                      "font_family": "system-ui, sans-serif", "head_font_family": "system-ui, sans-serif", "font_size": "16px", "code_font_size": "0.88em",
                      "sidebar_header": "#222", "sidebar_link": "#333", "gray_1": "#333", "gray_2": "#f3f4f6", "link": "#0b57a4", "link_hover": "#083d73",
                      "sidebar_collapse": True}
html_sidebars = {"**": ["about.html", "searchbox.html", "navigation.html"]}
html_title = f"elastogear {version}"
templates_path = ["templates"]
html_static_path = [os.path.join(os.path.dirname(os.path.abspath(__file__)), "static")]
html_css_files = ["site.css"]
html_extra_path = [os.environ["ELASTOGEAR_EXTRA"]]
html_copy_source = False
html_show_sphinx = False
html_use_index = True
graphviz_output_format = "svg"
