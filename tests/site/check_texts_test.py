# SPDX-License-Identifier: BSD-3-Clause
"""packaging/check_texts.py passes good texts and finds each kind of fault: check_texts_test.py SOURCE SCRATCH"""
import contextlib
import io
import os
import shutil
import sys

sys.path.insert(0, os.path.join(sys.argv[1], "packaging"))
import check_texts

ROW = 'constexpr std::tuple kFields{Field{"a", &A::a, 1.0, within(0.0, 1.0), "s", %s, Level::Common}};\n'
GOOD = {
    "README.md": "# Name\n\nA [link](docs/style.md), `beside` in code, *Label beside it*.\n\n    code beside code\n",
    "docs/long.md": "| a table row " + "x" * 130 + " |\n\n```\n" + "x" * 140 + "\n```\n[text](" + "x" * 140 + ")\n",
    "docs/allowed.md": "A value is held. <!-- style: held -->\nA hand-held camera.\n",
    "core/a/a.h": 'int beside;  // next to it\nconst char* b = "beside";  // a name\nint d;  // held by a prior // style: held\n',
    "core/a/a_options.cpp": ROW % '"Help of a row."',
    "docs/a.ipynb": '{"cells": [{"cell_type": "markdown", "source": ["`beside` in code"]}, {"cell_type": "code", "source": ["beside = 1"]}]}',
    "LICENSE": "Ours.\n\nBSD 3-Clause License\n\nBeside the point: not ours.\n",
}
BAD = {
    "a long line": ("docs/a.md", "word " * 30, "docs/a.md:1: 150 characters in a line"),
    "a phrase in a document": ("docs/a.md", "First.\nIt is beside the point.", 'docs/a.md:2: "beside"'),
    "a phrase in capitals": ("docs/a.md", "Beside the point.", '"Beside"'),
    "a phrase in a table": ("docs/a.md", "| it lies there |", '"lies"'),
    "another phrase than the allowed one": ("docs/a.md", "It lies. <!-- style: held -->", '"lies"'),
    "a README of many lines": ("README.md", "a\n" * 121, "121 lines"),
    "a README of many words": ("README.md", ("word " * 20 + "\n") * 50, "1000 words"),
    "a phrase in a comment": ("core/a/b.cpp", "int a;\nint b;  // beside it", 'core/a/b.cpp:2: "beside"'),
    "a phrase in a string": ("ui/b.cpp", 'const char* a = "it \\"is said\\" twice";', 'ui/b.cpp:1: "is said"'),
    "a phrase in a notebook": ("docs/a.ipynb", '{"cells": [{"cell_type": "markdown", "source": ["One.\\n", "It lies here."]}]}',
                               'docs/a.ipynb:1: "lies"'),
    "a phrase in a notebook's comment": ("docs/a.ipynb", '{"cells": [{"cell_type": "code", "source": ["a = 1  # beside it"]}]}', '"beside"'),
    "a phrase in LICENSE": ("LICENSE", "What is licensed how\n\nBSD 3-Clause License\n", 'LICENSE:1: "is licensed how"'),
    "a phrase in the page of the API": ("docs/api/main_page.md", "How the folders hang together", '"hang together"'),
    "a long help": ("core/a/b_options.cpp", ROW % ('"%s"\n  "%s"' % ("word " * 20, "word " * 20)), "help of 200 characters"),
}
scratch, wrong = sys.argv[2], []


def outcome(changed, most):
    """Exit code and output for the good tree with these files changed."""
    shutil.rmtree(scratch, ignore_errors=True)
    with open(f"{sys.argv[1]}/docs/style.md", encoding="utf-8") as style:
        tree = {**GOOD, **changed, "docs/style.md": style.read()}
    for path, text in tree.items():
        os.makedirs(os.path.dirname(f"{scratch}/{path}"), exist_ok=True)
        with open(f"{scratch}/{path}", "w", encoding="utf-8") as file:
            file.write(text)
    check_texts.MOST = most
    output = io.StringIO()
    with contextlib.redirect_stdout(output):
        code = check_texts.Check(scratch).run()
    return code, output.getvalue()


code, output = outcome({}, {})
if code != 0:
    wrong.append(f"good texts: {output}")
for name, (path, text, words) in BAD.items():
    code, output = outcome({path: text}, {})
    if code == 0 or words not in output:
        wrong.append(f"{name}: expected {words}, got {output}")
two = {"core/a/b.h": "// beside it\n// beside them\n"}
for most, expected, words in ((2, 0, "core 2 of 2"), (3, 0, "core 2 of 3 (lower the maximum)"), (1, 1, "core: 2 faults, at most 1")):
    code, output = outcome(two, {"core": most})
    if code != expected or words not in output:
        wrong.append(f"a maximum of {most}: expected {words}, got {output}")
print("\n".join(wrong) or f"check_texts.py finds {len(BAD)} kinds of faults")
sys.exit(bool(wrong))
