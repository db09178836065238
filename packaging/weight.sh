#!/usr/bin/env bash
# Prints the size of the project: packaging/weight.sh [--check] [FOLDER]
# Lines and files of each folder with its budget (docs/architecture.md), levels of dependencies, options of each level, words of
# the README, and the time of the last build for each folder, if there is one. --check fails if a folder exceeds its
# budget, or has none. FOLDER is a checkout, by default this one.
set -euo pipefail
exec python3 - "$(cd "$(dirname "$0")/.." && pwd)" "$@" <<'PYTHON'
import collections
import re
import sys
from pathlib import Path

here, *arguments = sys.argv[1:]
check = "--check" in arguments
root = Path(next((a for a in arguments if a != "--check"), here))
SOURCES = {".h", ".cpp"}


def folder_of(path):
    """The layer that a source below core, ui, app, python or tests belongs to."""
    parts = path.relative_to(root).parts
    nested = parts[0] == "core" and parts[1] == "pipeline"
    depth = {"core": 3 if nested else 2, "ui": 2, "tests": 1}.get(parts[0], 1)
    return "/".join(parts[: min(depth, len(parts) - 1)])


texts = {}
for top in ("core", "ui", "app", "python", "tests"):
    for path in sorted((root / top).rglob("*")):
        if path.suffix in SOURCES:
            texts[path] = path.read_text(errors="replace")

lines, files = collections.Counter(), collections.Counter()
needs = collections.defaultdict(set)
for path, text in texts.items():
    folder = folder_of(path)
    lines[folder] += text.count("\n")
    files[folder] += 1
    for include in re.findall(r'^#include "((?:core|ui)/[^"]+)"', text, re.M):
        target = folder_of(root / include)
        if target != folder:
            needs[folder].add(target)

levels = {}


def level(folder, path=()):
    """1 for a folder without dependencies; else one more than the highest level of its dependencies."""
    if folder in path:
        raise SystemExit("Circle: " + " -> ".join((*path, folder)))
    if folder not in levels:
        levels[folder] = 1 + max((level(other, (*path, folder)) for other in needs[folder]), default=0)
    return levels[folder]


budgets = {}
page = root / "docs/architecture.md"
for row in page.read_text().splitlines() if page.is_file() else []:
    cells = [cell.strip() for cell in row.strip("|").split("|")]
    if len(cells) == 3 and cells[2].isdigit():
        budgets[cells[0].strip("`").rstrip("/")] = int(cells[2])

# Wall time of each compiled object. A compiler has one thread, so this is its processor time if the machine is not overloaded.
seconds = collections.Counter()
log = root / "build/ci/.ninja_log"
for entry in log.read_text().splitlines()[1:] if log.is_file() else []:
    begin, end, _, output, _ = entry.split("\t")
    parts = output.split("/CMakeFiles/")
    if output.endswith(".o") and (root / parts[0]).is_dir():
        seconds[folder_of(root / parts[0] / "object")] += (int(end) - int(begin)) / 1000

problems = []
print(f"{'folder':<28}{'lines':>8}{'budget':>8}{'files':>7}{'level':>7}{'build, s':>10}")
for folder in sorted(lines):
    budget = budgets.get(folder)
    print(f"{folder:<28}{lines[folder]:>8}{budget or '-':>8}{files[folder]:>7}{level(folder):>7}{seconds[folder]:>10.0f}")
    if budget is None:
        problems.append(f"{folder} has no budget in docs/architecture.md")
    elif lines[folder] > budget:
        problems.append(f"{folder} has {lines[folder]} lines, and its budget is {budget}")
product = [folder for folder in lines if folder != "tests"]
for name in ("core", "ui", "app", "python"):
    mine = [f for f in product if f.split("/")[0] == name]
    print(f"{name:<28}{sum(lines[f] for f in mine):>8}{'':>8}{sum(files[f] for f in mine):>7}")
print(f"{'product':<28}{sum(lines[f] for f in product):>8}{'':>8}{sum(files[f] for f in product):>7}")
pipeline = [folder for folder in lines if folder.startswith("core/pipeline/")]
inside = {folder: needs[folder] & set(pipeline) for folder in pipeline}
depth = {}
for folder in sorted(pipeline, key=level):
    depth[folder] = 1 + max((depth[other] for other in inside[folder]), default=0)
if pipeline:
    print(f"core/pipeline: {len(pipeline)} folders, {max(depth.values())} levels, {sum(map(len, inside.values()))} edges")

rows = collections.Counter()
for path, text in texts.items():
    if path.suffix == ".cpp" and path.relative_to(root).parts[0] == "core":
        for row in re.split(r'\b(?=(?:Field|Switch|Choice)\{\s*")', text)[1:]:
            found = re.search(r"Level::(\w+)", row)
            rows[found.group(1) if found else "Tuning"] += 1
print("options:", ", ".join(f"{count} {name.lower()}" for name, count in sorted(rows.items())) or "none")
readme = root / "README.md"
if readme.is_file():
    print(f"README.md: {len(readme.read_text().split())} words")

if check and problems:
    print("\nToo heavy:", *problems, sep="\n  ", file=sys.stderr)
    print("Remove code, or raise the budget in a separate commit that gives the reason.", file=sys.stderr)
    sys.exit(1)
PYTHON
