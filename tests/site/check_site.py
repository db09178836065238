# SPDX-License-Identifier: BSD-3-Clause
"""Follows every link and anchor of the built site, and finds Markdown that was not converted to HTML: check_site.py SITE"""
import os
import re
import sys
from html.parser import HTMLParser
from urllib.parse import unquote

LOADS = {"script": "src", "img": "src", "link": "href"}  # resources that a page loads
NOT_RENDERED = re.compile(r"\]\(\S+\)|<!-- |^\s*(?:[-*] |\d+\. |\||```|#+ )", re.MULTILINE)
LARGEST_PICTURE = 200_000


class Page(HTMLParser):
    def __init__(self, path):
        super().__init__()
        self.anchors, self.links, self.loads, self.left_over = {""}, [], [], []
        self.open, self.pictures_without_words = [], []
        with open(path, encoding="utf-8") as file:
            self.feed(file.read())

    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        self.anchors.update(given[key] for key in ("id", "name") if given.get(key))
        if tag == "a" and given.get("href"):
            self.links.append(given["href"])
        elif tag in LOADS and given.get(LOADS[tag]):
            self.loads.append(given[LOADS[tag]])
        if tag == "img" and not given.get("alt"):
            self.pictures_without_words.append(given.get("src"))
        if tag in ("p", "code", "pre"):
            self.open.append(tag)

    def handle_endtag(self, tag):
        if self.open and self.open[-1] == tag:
            self.open.pop()

    def handle_data(self, data):
        if self.open == ["p"] and NOT_RENDERED.search(data):
            self.left_over.append(data.strip()[:80])


def faults_of(site):
    pages = {}
    for folder, _, files in os.walk(site):
        for file in files:
            if file.endswith(".html"):
                path = os.path.join(folder, file)
                pages[os.path.normpath(path)] = Page(path)
    faults = [] if pages else [f"{site}: no page at all"]
    for path, page in pages.items():
        if os.path.basename(path) == "404.html":
            continue  # with links from the server's root
        name = os.path.relpath(path, site)
        for link in page.links + page.loads:
            if re.match(r"[a-z]+:|//", link):
                if link in page.loads:
                    faults.append(f"{name}: needs {link} from the network")
                continue
            target, _, anchor = link.partition("#")
            full = os.path.normpath(os.path.join(os.path.dirname(path), unquote(target.split("?")[0]))) if target else path
            if not os.path.isfile(full):
                faults.append(f"{name}: {link} does not exist")
            elif full in pages and unquote(anchor) not in pages[full].anchors:
                faults.append(f"{name}: {link} has no such place")
        faults += [f"{name}: Markdown in the text: {text}" for text in page.left_over]
        faults += [f"{name}: {picture} has no words for who does not see it" for picture in page.pictures_without_words]
    for folder, _, files in os.walk(os.path.join(site, "pictures")):
        faults += [f"{file}: {os.path.getsize(os.path.join(folder, file))} bytes" for file in files
                   if os.path.getsize(os.path.join(folder, file)) > LARGEST_PICTURE]
    return pages, faults


if __name__ == "__main__":
    pages, faults = faults_of(sys.argv[1])
    print("\n".join(faults) or f"{len(pages)} pages, {sum(len(page.links) for page in pages.values())} links")
    sys.exit(bool(faults))
