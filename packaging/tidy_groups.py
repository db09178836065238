"""Runs clang-tidy over core, app, ui and python: python3 packaging/tidy_groups.py BUILD [SOURCE...] [--changed BASE] [--limit S].

BUILD is a folder that CMake has configured with EVICAL_UNITY=OFF, so that it lists every source. Nothing needs to be compiled in it.
--changed checks the sources that differ from commit BASE, then those that include a header that differs. After S seconds,
no further sources are begun.

Most of clang-tidy's time goes into the headers of Eigen, Ceres, Qt and VTK, which it reads again for every source. Therefore the
sources of a folder are checked as one unit that includes them. A source that does not compile in its unit is checked alone. GCC's
precompiled headers are removed from the commands, since clang cannot read them.
"""
import argparse
import collections
import json
import os
import re
import resource
import shlex
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
FOLDERS = ("core", "app", "ui", "python")
CHECKED = tuple(f"{ROOT / folder}{os.sep}" for folder in FOLDERS)
MOST_SOURCES = 12  # in a unit: with more, one core idles at the end while the other is busy with the last
ORDER_MATTERS = re.compile(r"^#include <(?:GL|EGL)/", re.M)  # sources with these are checked alone
INCLUDE = re.compile(r'^#include "([^"]+)"', re.M)  # the project's own headers: paths from the root
ALL_CHANGE = (".clang-tidy", "packaging/tidy_groups.py", "packaging/check-tidy.sh")
AT_ONCE = int(os.environ.get("EVICAL_TIDY_JOBS", 2))


def flags_of(command):
    """Compiler flags without source, output, warnings and precompiled headers; a flag with an argument is a pair."""
    arguments, flags, at = shlex.split(command), [], 0
    while at < len(arguments) and not arguments[at].startswith("-"):  # launcher and compiler
        at += 1
    while at < len(arguments):
        argument = arguments[at]
        pair = argument in ("-o", "-c", "-include", "-isystem", "-I", "-D")
        if argument in ("-isystem", "-I", "-D"):
            flags.append(tuple(arguments[at:at + 2]))
        elif not pair and not argument.startswith("-W") and argument != "-fpch-preprocess":
            flags.append((argument,))
        at += 2 if pair else 1
    return flags


def kind_of(source):
    """Sources of one kind are compiled with the same flags: core with the command line, the window, and its 3D view, since VTK and
    Qt's other parts bring macros that disturb each other."""
    ui = f"{ROOT / 'ui'}{os.sep}"
    if not source.startswith(ui):
        return "core"
    return "scene" if source.startswith(f"{ui}scene{os.sep}") else "ui"


def units_of(sources):
    """Groups of sources that are checked together: those of a folder, at most MOST_SOURCES."""
    folders = collections.defaultdict(list)
    for source in sorted(sources):
        alone = ORDER_MATTERS.search(Path(source).read_text())
        folders[source if alone else os.path.dirname(source)].append(source)
    units = [group[i:i + MOST_SOURCES] for group in folders.values() for i in range(0, len(group), MOST_SOURCES)]
    return sorted(units, key=lambda unit: -len(unit))


def git(*arguments):
    return subprocess.run(["git", "-C", str(ROOT), *arguments], capture_output=True, text=True, check=True).stdout.splitlines()


def changed_since(base, sources):
    """The sources that differ from a commit in the working tree, and those that only include a header that differs."""
    changed = set(git("diff", "--name-only", base)) | set(git("ls-files", "--others", "--exclude-standard"))
    own = [source for source in sources if os.path.relpath(source, ROOT) in changed]
    if changed & set(ALL_CHANGE):
        return own, sorted(set(sources) - set(own))
    files = git("ls-files", "--cached", "--others", "--exclude-standard", "--", *FOLDERS)
    includers = collections.defaultdict(set)
    for file in files:
        if file.endswith((".cpp", ".h")) and (ROOT / file).is_file():
            for included in INCLUDE.findall((ROOT / file).read_text()):
                includers[included].add(file)
    reached, open_ends = set(), list(changed)
    while open_ends:
        file = open_ends.pop()
        if file not in reached:
            reached.add(file)
            open_ends.extend(includers[file])
    return own, [source for source in sources if os.path.relpath(source, ROOT) in reached - changed]


class Checker:
    def __init__(self, scratch, flags):
        self.scratch, self.flags, self.problems = scratch, flags, set()
        scratch.mkdir(exist_ok=True)

    def run(self, name, sources):
        """The findings of clang-tidy in these sources and our headers, and its exit code."""
        unit = self.scratch / f"{name}.cpp"
        unit.write_text("".join(f'#include "{source}"\n' for source in sources))
        ours = f"^({'|'.join(map(re.escape, CHECKED))})"
        outcome = subprocess.run(
            ["clang-tidy", f"--config-file={ROOT / '.clang-tidy'}", f"--header-filter={ours}", "--quiet", str(unit), "--",
             *self.flags[kind_of(sources[0])], "-Wno-everything"], cwd=self.scratch, capture_output=True, text=True)
        return outcome.stdout + (outcome.stderr if outcome.returncode and not outcome.stdout else ""), outcome.returncode

    def check(self, name, unit):
        """Prints the findings in a unit. Returns True if there are none."""
        begin = time.monotonic()
        together, alone = list(unit), []
        found, code = self.run(name, together)
        while code and len(together) > 1:
            broken = re.search(r"^(\S+?):\d+:\d+: error: .*\[clang-diagnostic-error\]", found, re.M)
            if not broken:
                break
            source = broken.group(1)
            if source not in together:  # in a header, which any source may include
                alone, together, found, code = together + alone, [], "", 0
                break
            print(f"  alone: {os.path.relpath(source, ROOT)} ({broken.group(0).split(': ', 2)[2]})", flush=True)
            together.remove(source)
            alone.append(source)
            found, code = self.run(name, together)
        for i, source in enumerate(alone):
            more, its_code = self.run(f"{name}_{i}", [source])
            found, code = found + more, code or its_code
        if os.environ.get("EVICAL_TIDY_TIMES"):
            print(f"  {name}: {len(unit)} sources, {time.monotonic() - begin:.1f} s", flush=True)
        problems = set(re.findall(r"^\S+?:\d+:\d+: (?:error|warning): .*", found, re.M))
        new = problems - self.problems  # findings in headers repeat in other units
        self.problems |= problems
        if code:
            print("\n".join(sorted(new)) if problems else found or f"{name}: clang-tidy ended with {code}", flush=True)
        return code == 0


def main():
    parser = argparse.ArgumentParser(description="clang-tidy over core, app, ui and python")
    parser.add_argument("build", type=Path)
    parser.add_argument("sources", nargs="*")
    parser.add_argument("--changed", metavar="BASE")
    parser.add_argument("--limit", metavar="S", type=float, default=float("inf"))
    asked = parser.parse_args()
    entries = [entry for entry in json.loads((asked.build / "compile_commands.json").read_text())
               if entry["file"].startswith(CHECKED) and entry["file"].endswith(".cpp") and "_autogen" not in entry["file"]]
    flags = collections.defaultdict(dict)
    for entry in entries:  # the union of the flags of a kind's sources, each once and in order
        flags[kind_of(entry["file"])].update(dict.fromkeys(flags_of(entry["command"])))
    flags = {kind: [word for flag in own for word in flag] for kind, own in flags.items()}
    sources = sorted({entry["file"] for entry in entries})
    if not sources:
        parser.error(f"{asked.build} has no commands for the sources of this folder: configure it again")
    if asked.sources:
        wanted = {str(Path(source).resolve()) for source in asked.sources}
        unknown = wanted - set(sources)
        if unknown:
            parser.error(f"not built: {', '.join(sorted(unknown))}")
        sources = sorted(wanted)
    units = units_of(sources)
    if asked.changed and not asked.sources:
        units = [unit for part in changed_since(asked.changed, sources) for unit in units_of(part)]
    checker = Checker(asked.build.resolve() / "tidy", flags)
    begin = time.monotonic()

    def check(at):
        late = time.monotonic() - begin > asked.limit
        return None if late else checker.check(f"unit_{at}", units[at])

    with ThreadPoolExecutor(AT_ONCE) as pool:
        content = list(pool.map(check, range(len(units))))
    spent = resource.getrusage(resource.RUSAGE_CHILDREN)
    checked = sum(len(unit) for unit, result in zip(units, content) if result is not None)
    print(f"clang-tidy: {checked} sources of {sum(map(len, units))} in {len(units)} units, {time.monotonic() - begin:.0f} s "
          f"({spent.ru_utime + spent.ru_stime:.0f} s of CPU), {len(checker.problems)} problems.")
    return 1 if False in content else 0


if __name__ == "__main__":
    sys.exit(main())
