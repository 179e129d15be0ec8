# SPDX-License-Identifier: Apache-2.0
"""Settings of Sphinx for the site. scripts/site/site.py copies the pages into a folder and runs Sphinx on it."""
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]

project = "lfrendertools"
release = version = (ROOT / "VERSION").read_text().split()[0]
project_copyright = "the authors of lfrendertools"
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx_copybutton"]
exclude_patterns = []
highlight_language = "text"  # blocks without a language are commands and diagrams
# Pages show JSON that is cut off by three dots.
suppress_warnings = ["misc.highlighting_failure"]

# html_image: <img> in a page, which forges show with a width, is a picture of the site.
myst_enable_extensions = ["html_image"]
# Headings have the anchors that forges give them.
myst_heading_anchors = 4

# The Python package is described without being built: its extension and NumPy are not imported.
sys.path.insert(0, str(ROOT / "python"))
sys.path.insert(0, str(ROOT / "scripts/site"))
import site_theme
autodoc_mock_imports = ["lfrendertools._core", "numpy"]
autodoc_typehints = "none"  # the docstrings state the types
autodoc_member_order = "bysource"
napoleon_google_docstring = False
default_role = "code"  # `name` in a docstring, as in Markdown
napoleon_use_ivar = True
napoleon_use_rtype = False
python_use_unqualified_type_names = True

copybutton_exclude = ".linenos, .gp"

html_theme = "furo"
html_title = f"lfrendertools {version}"
html_static_path = ["static"]
html_css_files = ["site.css"]
html_favicon = "static/logo.svg"
html_copy_source = False
html_show_sphinx = False
pygments_style = "tango"
pygments_dark_style = "monokai"
html_theme_options = {
    "light_logo": "logo.svg",
    "dark_logo": "logo.svg",
    "sidebar_hide_name": False,
    "light_css_variables": {"color-brand-primary": "#8a4b00", "color-brand-content": "#8a4b00"},
    "dark_css_variables": {**site_theme.DARK, "color-brand-primary": "#ffb454", "color-brand-content": "#ffb454"},
}
