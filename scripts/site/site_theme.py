# SPDX-License-Identifier: Apache-2.0
"""Mends faults of Debian's package of the theme furo (2022.12.07+dfsg) in a made site, for site.py. Each is left alone
where another package does not have it.

- furo.css imports normalize.css from the server of the reader: it is put in place of the import.
- furo.js is a module that imports another one, but pages load it as a script, so that no button works: both are joined.
"""
import pathlib
import re

NORMALIZE = pathlib.Path("/usr/share/javascript/normalize.css/normalize.css")
IMPORT_STYLE = re.compile(r"@import url\(/javascript/normalize\.css/normalize\.css\);")
IMPORT_SCRIPT = re.compile(r'^import Gumshoe from "\./gumshoe-patched\.js";\n')
# The colours of furo's dark pages. Debian's furo.css has them for readers who press the button, but not for those whose
# browser asks for dark pages.
DARK = {
    "color-problematic": "#ee5151", "color-foreground-primary": "#ffffffcc", "color-foreground-secondary": "#9ca0a5",
    "color-foreground-muted": "#81868d", "color-foreground-border": "#666666", "color-background-primary": "#131416",
    "color-background-secondary": "#1a1c1e", "color-background-hover": "#1e2124ff",
    "color-background-hover--transparent": "#1e212400", "color-background-border": "#303335",
    "color-background-item": "#444", "color-highlighted-background": "#083563",
    "color-guilabel-background": "#08356380", "color-guilabel-border": "#13395f80",
    "color-api-keyword": "var(--color-foreground-secondary)", "color-highlight-on-target": "#333300",
    "color-admonition-background": "#18181a", "color-card-border": "var(--color-background-secondary)",
    "color-card-background": "#18181a", "color-card-marginals-background": "var(--color-background-hover)",
}


def mend(site: pathlib.Path):
    """Mends the files of a made site in place."""
    style = site / "_static/styles/furo.css"
    text = style.read_text()
    if IMPORT_STYLE.search(text):
        normal = NORMALIZE.read_text()
        style.write_text(IMPORT_STYLE.sub(lambda _: normal, text))
    script = site / "_static/scripts/furo.js"
    text = script.read_text()
    if IMPORT_SCRIPT.match(text):
        imported = (site / "_static/scripts/gumshoe-patched.js").read_text()
        script.write_text(imported + "\n" + IMPORT_SCRIPT.sub("", text))
