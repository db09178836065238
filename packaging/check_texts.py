#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Checks texts against docs/style.md: check_texts.py [SOURCE]

Fails on long lines in Markdown, a long README, long help of options, and phrases of the style's table in Markdown (with the page
of the API), in notebooks, in our part of LICENSE, in comments and in string literals of C++ sources. A phrase that is right in its
place is allowed by a comment on its line: style: PHRASE, as <!-- style: held --> or // style: held. What still has phrases has a maximum below: lower it when texts improve."""
import collections
import json
import os
import re
import sys

LONGEST_LINE, LONGEST_HELP = 130, 160  # characters
README_LINES, README_WORDS = 120, 900
# Phrases, long lines and long helps that are still allowed, by file or folder. Everything else has none.
MOST = {"core": 0, "ui": 0, "app": 0, "python": 0, "tests": 0}
NOT_WRITTEN_HERE = ("docs/options.md",)  # the output of evical options
CODE = ("core", "ui", "app", "python", "tests", "examples")

CODE_SPAN = re.compile(r"``[^`\n]+``|`[^`\n]*`")
LABEL = re.compile(r"(?<![*\w])\*[^*\n]+\*(?![*\w])")  # of the window; its texts are checked in its sources
LINK_TARGET = re.compile(r"\]\([^()\s]+\)|<[a-z]+:[^>\s]+>|https?://\S+")
MARKDOWN_MARKER, CPP_MARKER = re.compile(r" *<!-- style: (.*?) -->"), re.compile(r" *// style: (.*)$")
LITERAL = re.compile(r'"((?:[^"\\\n]|\\.)*)"')
COMMENT = re.compile(r"(?:^|[\s;{}),])//+[!<]*\s?(.*)$")


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def pattern_of(phrase):
    return r"\b" + r"\s+".join(re.escape(word) for word in phrase.split()) + r"\b"


def phrases_of(style):
    """One pattern for all phrases of the style's table: code spans of its first column, less those of "but not"."""
    table = style.partition("## Phrases to replace")[2]
    rows = [row.split("|") for row in re.findall(r"^\|.*`.*\|$", table, re.MULTILINE)]
    spans = [[re.findall(r"`([^`]+)`", cells[column]) for cells in rows if len(cells) > column] for column in (1, 3)]
    wanted, allowed = ([phrase for cell in column for phrase in cell] for column in spans)
    if len(wanted) < 10:
        sys.exit("docs/style.md: the table of phrases is missing")
    longest_first = lambda names: "|".join(pattern_of(name) for name in sorted(names, key=len, reverse=True))  # noqa: E731
    return re.compile(f"(?P<allowed>{longest_first(allowed) or '(?!)'})|(?P<wanted>{longest_first(wanted)})", re.IGNORECASE)


class Check:
    def __init__(self, root):
        self.root, self.faults, self.sources = root, collections.defaultdict(list), 0
        self.phrases = phrases_of(read(f"{root}/docs/style.md"))

    def fault(self, path, number, what):
        key = next((key for key in MOST if path == key or path.startswith(key + "/")), "")
        self.faults[key].append(f"{path}:{number}: {what}")

    def prose(self, path, number, text, allowed):
        for found in self.phrases.finditer(text):
            if found["wanted"] and found.group(0).lower() not in allowed:
                self.fault(path, number, f'"{found.group(0)}": docs/style.md has what to write')

    def markdown(self, path):
        fenced = False
        for number, line in enumerate(read(f"{self.root}/{path}").split("\n"), 1):
            fenced ^= line.lstrip().startswith("```")
            allowed = [marker.lower() for marker in MARKDOWN_MARKER.findall(line)]
            line = MARKDOWN_MARKER.sub("", line)
            if fenced or line.startswith("    ") or line.lstrip().startswith("```"):
                continue
            if not line.startswith("|") and len(LINK_TARGET.sub("]()", line)) > LONGEST_LINE:
                self.fault(path, number, f"{len(line)} characters in a line, at most {LONGEST_LINE}")
            self.prose(path, number, LINK_TARGET.sub("]", LABEL.sub("", CODE_SPAN.sub("``", line))), allowed)

    def notebook(self, path):
        for number, cell in enumerate(json.loads(read(f"{self.root}/{path}"))["cells"], 1):
            for line in "".join(cell["source"]).split("\n"):
                text = CODE_SPAN.sub("``", line) if cell["cell_type"] == "markdown" else line.partition("#")[2]
                self.prose(path, number, LINK_TARGET.sub("]", text), [])

    def licence(self):
        if os.path.exists(f"{self.root}/LICENSE"):
            for number, line in enumerate(read(f"{self.root}/LICENSE").partition("BSD 3-Clause License\n")[0].split("\n"), 1):
                self.prose("LICENSE", number, line, [])

    def source(self, path):
        self.sources += 1
        text = read(f"{self.root}/{path}")
        for number, line in enumerate(text.split("\n"), 1):
            marker = CPP_MARKER.search(line)
            line = CPP_MARKER.sub("", line)
            allowed = [marker.group(1).strip().lower()] if marker else []
            literals = [literal for literal in LITERAL.findall(line) if " " in literal]
            comment = COMMENT.search(LITERAL.sub('""', line))
            for part in literals + ([comment.group(1)] if comment else []):
                self.prose(path, number, part, allowed)
        if re.match(r"core/.*options?[^/]*\.cpp$", path):
            for number, text in helps_of(text):
                if len(text) > LONGEST_HELP:
                    self.fault(path, number, f"help of {len(text)} characters, at most {LONGEST_HELP}: {text[:50]}...")

    def readme(self):
        lines = read(f"{self.root}/README.md").rstrip("\n").split("\n")
        words = sum(len(line.split()) for line in lines)
        for count, most, what in ((len(lines), README_LINES, "lines"), (words, README_WORDS, "words")):
            if count > most:
                self.fault("README.md", 1, f"{count} {what}, at most {most}: longer texts are pages in docs/")

    def run(self):
        documents = sorted(path for path in files(self.root, ("",), ".md") if path not in NOT_WRITTEN_HERE)
        for path in documents:
            self.markdown(path)
        notebooks = sorted(files(self.root, ("",), ".ipynb"))
        for path in notebooks:
            self.notebook(path)
        self.licence()
        for path in sorted(path for end in (".h", ".cpp") for path in files(self.root, CODE, end)):
            self.source(path)
        self.readme()
        counts = []
        for key, most in MOST.items():
            found = self.faults.pop(key, [])
            counts.append(f"{key} {len(found)} of {most}" + (" (lower the maximum)" if len(found) < most else ""))
            if len(found) > most:
                self.faults[key] = found + [f"{key}: {len(found)} faults, at most {most} in packaging/check_texts.py"]
        for fault in sum(self.faults.values(), []):
            print(fault)
        print(f"Texts: {len(documents)} documents, {len(notebooks)} notebooks, {self.sources} sources; allowed for now: {', '.join(counts) or 'nothing'}.")
        return 1 if self.faults else 0


def helps_of(text):
    """(line, help) of each row of an option table: the row's last string that has a space and is in no inner brackets."""
    for row in re.finditer(r"\b(?:Field|Switch|Choice)\s*\{", text):
        depth, end, strings, apart = 1, row.end(), [], True
        for token in re.compile(r'"((?:[^"\\]|\\.)*)"|[{}(),]|\s+|[^\s"{}(),]+').finditer(text, row.end()):
            end, word = token.end(), token.group(0)
            depth += {"{": 1, "(": 1, "}": -1, ")": -1}.get(word, 0)
            if depth == 0:
                break
            if word[0] == '"' and depth == 1:
                strings[len(strings) if apart else -1:] = [token.group(1) if apart else strings[-1] + token.group(1)]
                apart = False
            elif not word.isspace():
                apart = True
        helps = [string for string in strings if " " in string]
        if helps:
            yield text.count("\n", 0, end) + 1, helps[-1]


def files(root, tops, end):
    for top in tops:
        for folder, folders, names in os.walk(os.path.join(root, top)):
            folders[:] = [name for name in folders if name != "build" and not name.startswith(".") and name != "third_party"]
            yield from (os.path.relpath(os.path.join(folder, name), root) for name in names if name.endswith(end))


if __name__ == "__main__":
    sys.exit(Check(sys.argv[1] if len(sys.argv) > 1 else os.path.dirname(os.path.dirname(os.path.abspath(__file__)))).run())
