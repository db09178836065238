# SPDX-License-Identifier: BSD-3-Clause
"""Hooks of MkDocs for docs/ (mkdocs.yml). Pages include CHANGELOG.md, CONTRIBUTING.md and sections of the window's user guide,
    [its title](../resources/user_guide.md#a-section) <!-- include -->
notebooks become pages, and files of the repository that pages link to are copied to the site."""
import logging
import os
import re
import shutil
import tempfile
import warnings

from mkdocs.structure.files import File

log = logging.getLogger("mkdocs.plugins.docs_site")

INCLUDE = re.compile(r"^\[[^\]\n]*\]\((?P<path>[^)#\n]+)(?:#(?P<anchor>[^)\n]+))?\) <!-- include -->$", re.MULTILINE)
# Code first: text in it that looks like a link is not one.
LINK_OR_CODE = re.compile(r"^```.*?^```|^ {4}[^\n]*|``[^\n]+?``|`[^`\n]*`|(?P<text>!?\[[^\[\]]*\])\((?P<target>[^()\s]+)\)",
                          re.MULTILINE | re.DOTALL)
# A list directly below a text: GitHub recognises it, MkDocs only after an empty line.
LIST_BELOW_TEXT = re.compile(r"^(?![-*] |\d+\. |[ \n|#])([^\n]+\n)(?=- |1\. )", re.MULTILINE)
NOT_PAGES = ("api/",)  # Doxygen's
OPTIONAL = {"clusters.md"}  # in nav, and shown if the file exists

scratch = None
places = {}


def anchor_of(heading):
    """GitHub's anchor of a heading. MkDocs' anchors are the same for our headings; the test of links checks this."""
    return re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-")


def headings(text):
    """(line, level, anchor) of each heading outside fenced code."""
    found, fenced = [], False
    for index, line in enumerate(text.split("\n")):
        fenced ^= line.startswith("```")
        heading = re.match(r"(#+) (.*)", line)
        if heading and not fenced:
            found.append((index, len(heading.group(1)), anchor_of(heading.group(2))))
    return found


def section(text, anchor):
    """The text below a heading, up to the next one of its level; without an anchor all except the title. None if absent."""
    lines, known = text.split("\n"), headings(text)
    if anchor is None:
        return "\n".join(lines[known[0][0] + 1:] if known else lines)
    for index, level, name in known:
        if name == anchor:
            ends = [line for line, other, _ in known if line > index and other <= level]
            return "\n".join(lines[index + 1:ends[0] if ends else len(lines)])
    return None


def root(config):
    return os.path.dirname(config["config_file_path"])


def read(config, path):
    with open(os.path.join(root(config), path), encoding="utf-8") as file:
        return file.read()


def included(config, page_path, match):
    """The text, and the file of the repository that it comes from."""
    path = os.path.normpath(os.path.join(os.path.dirname(page_path), match["path"]))
    text = section(read(config, path), match["anchor"]) if os.path.isfile(os.path.join(root(config), path)) else None
    if text is None:
        log.warning("%s: there is no such text: %s", page_path, match.group(0))
    return text or "", path


class Page:
    """A page's links, rewritten for the site."""

    def __init__(self, path, config, files):
        self.path, self.config, self.files = path, config, files

    def expand(self, markdown):
        parts, end = [], 0
        for match in INCLUDE.finditer(markdown):
            parts.append(self.relinked(markdown[end:match.start()], self.path))
            text, source = included(self.config, self.path, match)
            parts.append(self.relinked(text, source))
            end = match.end()
        parts.append(self.relinked(markdown[end:], self.path))
        return "".join(parts)

    def relinked(self, text, source):
        def link(match):
            if match["target"] is None:
                return match.group(0)
            target = self.target(match["target"], source)
            return f"{match['text']}({target})" if target else match["text"][1:-1]

        return LIST_BELOW_TEXT.sub(r"\1\n", LINK_OR_CODE.sub(link, text))

    def target(self, target, source):
        """Target on the site of a link in this source; None for a folder."""
        if re.match(r"[a-z]+:", target) or (target.startswith("#") and source == self.path):
            return target
        path, _, anchor = target.partition("#")
        path = os.path.normpath(os.path.join(os.path.dirname(source), path)) if path else source
        place = self.place(path, anchor)
        if place is None:
            return None
        relative = os.path.relpath(place, os.path.dirname(self.path)).replace(os.sep, "/")
        has_anchor = anchor and (path.startswith("docs/") or anchor in [each[2] for each in headings(read(self.config, place))])
        return f"{relative}#{anchor}" if has_anchor else relative

    def place(self, path, anchor):
        full = os.path.join(root(self.config), path)
        if path.startswith("docs/"):
            return f"{path}/README.md" if os.path.isfile(f"{full}/README.md") else path
        page = places.get((path, anchor or None)) or places.get((path, "" if anchor else None))
        if page or os.path.isdir(full):
            return page
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
    places.clear()
    for file in list(files):
        if file.src_path.startswith(NOT_PAGES):
            files.remove(file)
        elif file.src_path.endswith(".ipynb"):
            for made in notebook_page(config, file):
                files.append(made)
        elif file.src_path.endswith(".md"):
            path = f"docs/{file.src_path}"
            for match in INCLUDE.finditer(read(config, path)):
                source = os.path.normpath(os.path.join(os.path.dirname(path), match["path"]))
                for key in {(source, match["anchor"]), (source, None)}:
                    places.setdefault(key, path)
    return files


def on_page_markdown(markdown, page, config, files):
    if page.file.src_path.startswith("notebooks/"):
        return markdown
    text = Page(f"docs/{page.file.src_path}", config, files).expand(markdown)
    return re.sub(r"(\]\((?:[^()\s]*/)?notebooks/[^()\s]*)\.ipynb\)", r"\1.md)", text)


def on_post_build(config):
    shutil.rmtree(scratch)


def on_build_error(error):
    shutil.rmtree(scratch or "", ignore_errors=True)
