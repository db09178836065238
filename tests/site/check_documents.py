# SPDX-License-Identifier: BSD-3-Clause
"""Links in the repository's documents must lead to existing files and headings of GitHub, and pictures must be drawings or those of
packaging/screenshots.sh: check_documents.py SOURCE"""
import os
import re
import sys

root = sys.argv[1]
CODE = re.compile(r"^```.*?^```|^ {4}[^\n]*|``[^\n]+?``|`[^`\n]*`", re.MULTILINE | re.DOTALL)
LINK = re.compile(r"\[[^\[\]]*\]\(([^()\s]+)\)")


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def anchors(text):
    """GitHub's anchors: the second one of a name ends in -1."""
    found = {}
    for heading in re.findall(r"^#+ (.+)$", re.sub(r"^```.*?^```", "", text, flags=re.MULTILINE | re.DOTALL), re.MULTILINE):
        name = re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-")
        found[name] = found.get(name, -1) + 1
    return {name if number == 0 else f"{name}-{number}" for name, most in found.items() for number in range(most + 1)}


faults, count, pictures = [], 0, set()
documents = [f"{root}/{name}" for name in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md")]
for top in ("docs", "resources"):
    documents += [os.path.join(folder, name) for folder, _, names in os.walk(f"{root}/{top}") for name in names if name.endswith(".md")]
for document in documents:
    if "<!-- include -->" in read(document):
        faults.append(f"{os.path.relpath(document, root)}: a page includes another one, so it cannot be read in the repository")
    for link in LINK.findall(CODE.sub("", read(document))):
        if re.match(r"[a-z]+:", link):
            continue
        count += 1
        path, _, anchor = link.partition("#")
        target = os.path.normpath(os.path.join(os.path.dirname(document), path)) if path else document
        name = os.path.relpath(document, root)
        if os.path.dirname(target) == os.path.normpath(f"{root}/docs/pictures"):
            pictures.add(os.path.basename(target))
        if not os.path.exists(target):
            faults.append(f"{name}: {link} does not exist")
        elif anchor and anchor not in anchors(read(target)):
            faults.append(f"{name}: {link} has no such heading")
if count < 50:
    faults.append(f"only {count} links were found")

made = {f"{name}.png" for name in re.search(r'shown="([^"]*)"', read(f"{root}/packaging/screenshots.sh")).group(1).split()}
stored = set(os.listdir(f"{root}/docs/pictures"))
made |= {name for name in stored if name.endswith(".svg")}  # drawn by hand
for what, names in (("is made", made), ("is shown", pictures)):
    faults += [f"docs/pictures/{name}: either it is there, or it {what}, not both" for name in sorted(stored ^ names)]
print("\n".join(faults) or f"{len(documents)} documents, {count} links")
sys.exit(bool(faults))
