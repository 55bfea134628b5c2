"""Extension of Sphinx: keyboards reach what scrolls sideways, and the headings of the sidebar have a level."""
from pathlib import Path

CHANGES = (('class="caption" role="heading"', 'class="caption" role="heading" aria-level="2"'), ("<pre>", '<pre tabindex="0">'),
           ('<table class="docutils', '<table tabindex="0" class="docutils'))


def mend(app, exception):
    for path in Path(app.outdir).rglob("*.html") if exception is None else ():
        text = changed = path.read_text(encoding="utf-8")
        for old, new in CHANGES:
            changed = changed.replace(old, new)
        if changed != text:
            path.write_text(changed, encoding="utf-8")


def setup(app):
    app.connect("build-finished", mend)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
