# SPDX-License-Identifier: BSD-3-Clause
"""check_site.py must find each kind of fault: check_site_test.py SCRATCH"""
import os
import shutil
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from check_site import faults_of

SOUND = ('<p id="top">A <a href="other.html#there">link</a>, <a href="https://example.org">one outside</a></p>'
         '<pre><code>- [no](link)</code></pre><img src="pictures/a.png" alt="words">')
SPOILT = {
    "a missing page": (SOUND + '<a href="gone.html">x</a>', "gone.html does not exist"),
    "a missing anchor": (SOUND + '<a href="other.html#gone">x</a>', "no such place"),
    "a missing anchor of the same page": (SOUND + '<a href="#gone">x</a>', "no such place"),
    "a missing picture": (SOUND + '<img src="gone.png" alt="x">', "gone.png does not exist"),
    "a picture without words": (SOUND + '<img src="pictures/a.png">', "has no words"),
    "a script from the network": (SOUND + '<script src="https://example.org/a.js"></script>', "from the network"),
    "a list that became none": (SOUND + "<p>Text\n- item</p>", "Markdown in the text"),
    "a table that became none": (SOUND + "<p>| a | b |</p>", "Markdown in the text"),
    "an include that was left": (SOUND + "<p>x <!-- include --> [a](b.md)</p>", "Markdown in the text"),
}
scratch = sys.argv[1]
wrong = []


def faults(page):
    shutil.rmtree(scratch, ignore_errors=True)
    os.makedirs(f"{scratch}/pictures")
    for name, text in {"index.html": page, "other.html": '<h1 id="there">Other</h1>', "pictures/a.png": "x"}.items():
        with open(f"{scratch}/{name}", "w", encoding="utf-8") as file:
            file.write(text)
    return faults_of(scratch)[1]


if faults(SOUND):
    wrong.append(f"a sound site: {faults(SOUND)}")
for name, (page, words) in SPOILT.items():
    found = faults(page)
    if not any(words in fault for fault in found):
        wrong.append(f"{name} is not reported: {found}")
shutil.rmtree(scratch)
os.makedirs(scratch)
if not faults_of(scratch)[1]:
    wrong.append("an empty site is not reported")
print("\n".join(wrong) or f"{len(SPOILT) + 1} faults are found")
sys.exit(bool(wrong))
