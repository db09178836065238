# SPDX-License-Identifier: BSD-3-Clause
"""Hooks of MkDocs for docs/ (mkdocs.yml). CONTRIBUTING.md, CHANGELOG.md and notebooks become pages, and files of the repository
that pages link to are copied to the site."""
import logging
import os
import re
import shutil
import tempfile
import warnings

from mkdocs.structure.files import File

log = logging.getLogger("mkdocs.plugins.docs_site")

# Code first: text in it that looks like a link is not one.
LINK_OR_CODE = re.compile(r"^```.*?^```|^ {4}[^\n]*|``[^\n]+?``|`[^`\n]*`|(?P<text>!?\[[^\[\]]*\])\((?P<target>[^()\s]+)\)",
                          re.MULTILINE | re.DOTALL)
# A list directly below a text: GitHub recognises it, MkDocs only after an empty line.
LIST_BELOW_TEXT = re.compile(r"^(?![-*] |\d+\. |[ \n|#])([^\n]+\n)(?=- |1\. )", re.MULTILINE)
NOT_PAGES = ("api/",)  # Doxygen's
OPTIONAL = {"clusters.md"}  # in nav, and shown if the file exists
ROOT_PAGES = {"contributing.md": "CONTRIBUTING.md", "changes.md": "CHANGELOG.md"}  # page of the site: file at the root

scratch = None


def root(config):
    return os.path.dirname(config["config_file_path"])


class Page:
    """A page's links, rewritten for the site."""

    def __init__(self, path, source, config, files):
        self.path, self.source, self.config, self.files = path, source, config, files  # page of the site, file of the repository

    def relinked(self, text):
        def link(match):
            if match["target"] is None:
                return match.group(0)
            target = self.target(match["target"])
            return f"{match['text']}({target})" if target else match["text"][1:-1]

        return LIST_BELOW_TEXT.sub(r"\1\n", LINK_OR_CODE.sub(link, text))

    def target(self, target):
        """Target on the site of a link; None for a folder."""
        if re.match(r"[a-z]+:|#", target):
            return target
        path, _, anchor = target.partition("#")
        place = self.place(os.path.normpath(os.path.join(os.path.dirname(self.source), path)))
        if place is None:
            return None
        relative = os.path.relpath(place, os.path.dirname(self.path)).replace(os.sep, "/")
        return f"{relative}#{anchor}" if anchor else relative

    def place(self, path):
        page = next((page for page, source in ROOT_PAGES.items() if source == path), None)
        if page:
            return f"docs/{page}"
        full = os.path.join(root(self.config), path)
        if path.startswith("docs/"):
            return f"{path}/README.md" if os.path.isfile(f"{full}/README.md") else path
        if os.path.isdir(full):
            return None
        if not os.path.isfile(full) or path.endswith(".md"):
            log.warning("%s: links to %s, which is %s", self.path, path, "on no page" if os.path.isfile(full) else "not there")
            return None
        name = f"files/{path}"
        if self.files.get_file_from_path(name) is None:
            self.files.append(File(name, scratch, self.config["site_dir"], False))
            os.makedirs(os.path.dirname(f"{scratch}/{name}"), exist_ok=True)
            shutil.copy(full, f"{scratch}/{name}")
        return f"docs/{name}"


def notebook_page(config, file):
    from nbconvert import MarkdownExporter  # slow to load

    name = os.path.splitext(file.src_path)[0]
    pictures = os.path.basename(name) + "_files"
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # about its own deprecated names
        text, resources = MarkdownExporter().from_filename(file.abs_src_path, resources={"output_files_dir": pictures})
    folder = os.path.join(scratch, os.path.dirname(name))
    os.makedirs(os.path.join(folder, pictures), exist_ok=True)
    for path, content in resources["outputs"].items():
        with open(os.path.join(folder, path), "wb") as picture:
            picture.write(content)
    title, _, rest = text.lstrip().partition("\n")
    with open(f"{scratch}/{name}.md", "w", encoding="utf-8") as page:
        page.write(f"{title}\n\nThe notebook itself: [{os.path.basename(file.src_path)}]({os.path.basename(file.src_path)}).\n{rest}")
    made = [f"{name}.md"] + [os.path.join(os.path.dirname(name), path) for path in resources["outputs"]]
    return [File(path, scratch, config["site_dir"], False) for path in made]


def without(nav, path):
    """Nav without the entries of one page, and without sections that become empty."""
    if isinstance(nav, list):
        return [kept for kept in (without(each, path) for each in nav) if kept]
    if isinstance(nav, dict):
        return {title: kept for title, kept in ((title, without(each, path)) for title, each in nav.items()) if kept}
    return None if nav == path else nav


def pages_of_notebooks(nav):
    if isinstance(nav, list):
        return [pages_of_notebooks(each) for each in nav]
    if isinstance(nav, dict):
        return {title: pages_of_notebooks(each) for title, each in nav.items()}
    return re.sub(r"\.ipynb$", ".md", nav)


def on_config(config):
    config["nav"] = pages_of_notebooks(config["nav"])
    for page in OPTIONAL:
        if not os.path.isfile(os.path.join(config["docs_dir"], page)):
            config["nav"] = without(config["nav"], page)
    return config


def on_files(files, config):
    global scratch
    scratch = tempfile.mkdtemp(prefix="evical_docs_")
    for page, source in ROOT_PAGES.items():
        shutil.copy(os.path.join(root(config), source), f"{scratch}/{page}")
        files.append(File(page, scratch, config["site_dir"], False))
    for file in list(files):
        if file.src_path.startswith(NOT_PAGES):
            files.remove(file)
        elif file.src_path.endswith(".ipynb"):
            for made in notebook_page(config, file):
                files.append(made)
    return files


def on_page_markdown(markdown, page, config, files):
    name = page.file.src_path
    if name.startswith("notebooks/"):
        return markdown
    text = Page(f"docs/{name}", ROOT_PAGES.get(name, f"docs/{name}"), config, files).relinked(markdown)
    return re.sub(r"(\]\((?:[^()\s]*/)?notebooks/[^()\s]*)\.ipynb\)", r"\1.md)", text)


def on_post_build(config):
    shutil.rmtree(scratch)


def on_build_error(error):
    shutil.rmtree(scratch or "", ignore_errors=True)
