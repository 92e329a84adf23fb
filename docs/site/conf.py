"""Sphinx reads the pages that tools/site/stage.py gathered; tools/docs calls both."""
import os
import pathlib
import sys

sys.path.insert(0, os.environ["UMOV_PACKAGE"])  # the package of the build, for autodoc and viewcode
import umov  # noqa: E402

project = "umov"
author = "the umov authors"
copyright = "the umov authors, BSD 3-Clause"
release = version = umov.__version__

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx.ext.viewcode"]
myst_enable_extensions = ["deflist", "attrs_inline"]
myst_heading_anchors = 3
root_doc = "index"
exclude_patterns = ["extra"]

napoleon_use_rtype = False
default_role = "code"  # single backticks of docstrings
add_module_names = False
autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_typehints_format = "short"
python_maximum_signature_line_length = 90

html_theme = "furo"
html_title = f"umov {release}"
html_static_path = ["static"]
html_extra_path = [str(pathlib.Path(__file__).parent / "extra"), os.environ["UMOV_REFERENCE"]]
html_css_files = ["umov.css"]
html_show_sphinx = False
html_copy_source = False
html_show_search_summary = False  # which is fetched, and a page from a disk may not fetch
pygments_style, pygments_dark_style = "friendly", "monokai"

