"""Runs clang-tidy over core, app, ui and python: python3 packaging/tidy_groups.py BUILD [SOURCE...].

Most of what clang-tidy costs is reading the headers of Eigen, Ceres, Qt and VTK, again for every source. So sources whose private
names don't collide are checked as one unit that includes them. A source that does not compile in its unit is checked alone.
Precompiled headers of GCC's are left out of the commands, since clang cannot read them.
"""
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
CHECKED = tuple(f"{ROOT / folder}{os.sep}" for folder in ("core", "app", "ui", "python"))
MOST_SOURCES = 12  # in a unit: with more, one core idles at the end while the other is busy with the last
ORDER_MATTERS = re.compile(r"^#include <(?:GL|EGL)/", re.M)  # sources with these are checked alone
AT_ONCE = int(os.environ.get("EVICAL_TIDY_JOBS", 2))


def flags_of(command):
    """What tells clang how to read a source: neither source, output, warnings nor precompiled headers. In pairs where they are."""
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


def private_names(text):
    """What unnamed namespaces declare, and macros; roughly: where it is wrong, a source is checked alone."""
    names = set(re.findall(r"^#define (\w+)", text, re.M)) | set(re.findall(r"^static .*?(\w+)\s*[(=]", text, re.M))
    for block in re.findall(r"^namespace \{\n(.*?)^\}  // namespace$", text, re.M | re.S):
        for line in block.splitlines():
            if line[:1] in ("", " ", "/", "}") or line.startswith(("using ", "namespace ")):
                continue  # not at the namespace's own level, or may be said twice
            declared = re.match(r"(?:class|struct|enum class|enum) (\w+)", line)
            function = re.search(r"(\w+)\(", line)
            if declared:
                names.add(declared.group(1))
            elif function and "=" not in line.split("(")[0]:
                names.add(function.group(1))
            else:
                names.update(re.findall(r"\b([A-Za-z]\w*)(?: =|\{|;|\[)", line))
    return names


def used_names(text):
    """Functions, types and constants that a source may mean: a private name of another source would hide them."""
    return set(re.findall(r"\b(\w+)\(", text)) | set(re.findall(r"\b(k?[A-Z]\w*)", text))


class Unit:
    def __init__(self, kind):
        self.kind, self.sources, self.private, self.used, self.apart = kind, [], set(), set(), False

    def takes(self, kind, private, used):
        return (kind == self.kind and not self.apart and len(self.sources) < MOST_SOURCES and not self.private & (private | used)
                and not private & self.used)

    def add(self, source, private, used):
        self.sources.append(source)
        self.private |= private
        self.used |= used


def kind_of(source):
    """Sources of one kind may share a unit: core with the command line, the window, and its 3D view, since VTK and Qt's other parts
    bring macros that disturb each other."""
    if not source.startswith(CHECKED[-1]):
        return "core"
    return "scene" if source.startswith(f"{CHECKED[-1]}scene{os.sep}") else "ui"


def units_of(kinds):
    """Which sources are checked together."""
    units = []
    for source, kind in sorted(kinds.items()):
        text = Path(source).read_text()
        private, used = private_names(text), used_names(text)
        apart = ORDER_MATTERS.search(text)
        unit = None if apart else next((unit for unit in units if unit.takes(kind, private, used)), None)
        if unit is None:
            unit = Unit(kind)
            unit.apart = bool(apart)
            units.append(unit)
        unit.add(source, private, used)
    return sorted(units, key=lambda unit: -len(unit.sources))


class Checker:
    def __init__(self, scratch, flags):
        self.scratch, self.flags, self.problems = scratch, flags, set()
        scratch.mkdir(exist_ok=True)

    def run(self, name, kind, sources):
        """What clang-tidy finds in these sources and our headers, and its exit code."""
        unit = self.scratch / f"{name}.cpp"
        unit.write_text("".join(f'#include "{source}"\n' for source in sources))
        ours = f"^({'|'.join(map(re.escape, CHECKED))})"
        outcome = subprocess.run(
            ["clang-tidy", f"--config-file={ROOT / '.clang-tidy'}", f"--header-filter={ours}", "--quiet", str(unit), "--",
             *self.flags[kind], "-Wno-everything"], cwd=self.scratch, capture_output=True, text=True)
        return outcome.stdout + (outcome.stderr if outcome.returncode and not outcome.stdout else ""), outcome.returncode

    def check(self, name, unit):
        """Prints what is found in a unit; whether that is nothing."""
        begin = time.monotonic()
        together, alone = list(unit.sources), []
        found, code = self.run(name, unit.kind, together)
        while code and len(together) > 1:
            broken = re.search(r"^(\S+?):\d+:\d+: error: .*\[clang-diagnostic-error\]", found, re.M)
            if not broken:
                break
            source = broken.group(1)
            if source not in together:  # in some header: it may be anyone's
                alone, together, found, code = together + alone, [], "", 0
                break
            print(f"  alone: {os.path.relpath(source, ROOT)} ({broken.group(0).split(': ', 2)[2]})", flush=True)
            together.remove(source)
            alone.append(source)
            found, code = self.run(name, unit.kind, together)
        for i, source in enumerate(alone):
            more, its_code = self.run(f"{name}_{i}", unit.kind, [source])
            found, code = found + more, code or its_code
        if os.environ.get("EVICAL_TIDY_TIMES"):
            print(f"  {name}: {len(unit.sources)} sources, {time.monotonic() - begin:.1f} s", flush=True)
        problems = set(re.findall(r"^\S+?:\d+:\d+: (?:error|warning): .*", found, re.M))
        new = problems - self.problems  # those of headers are found again and again
        self.problems |= problems
        if code:
            print("\n".join(sorted(new)) if problems else found or f"{name}: clang-tidy ended with {code}", flush=True)
        return code == 0


def main(build, wanted):
    entries = [entry for entry in json.loads((Path(build) / "compile_commands.json").read_text())
               if entry["file"].startswith(CHECKED) and entry["file"].endswith(".cpp") and "_autogen" not in entry["file"]]
    kinds = {entry["file"]: kind_of(entry["file"]) for entry in entries}
    flags = {}
    for entry in entries:  # all that any source of a kind is compiled with, once and in order
        flags.setdefault(kinds[entry["file"]], {}).update(dict.fromkeys(flags_of(entry["command"])))
    flags = {kind: [word for flag in own for word in flag] for kind, own in flags.items()}
    if wanted:
        kinds = {str(Path(source).resolve()): kinds[str(Path(source).resolve())] for source in wanted}
    units = units_of(kinds)
    checker = Checker(Path(build).resolve() / "tidy", flags)
    begin = time.monotonic()
    with ThreadPoolExecutor(AT_ONCE) as pool:
        content = list(pool.map(lambda at: checker.check(f"unit_{at}", units[at]), range(len(units))))
    spent = resource.getrusage(resource.RUSAGE_CHILDREN)
    print(f"clang-tidy: {len(kinds)} sources in {len(units)} units, {time.monotonic() - begin:.0f} s "
          f"({spent.ru_utime + spent.ru_stime:.0f} s of CPU), {len(checker.problems)} problems.")
    return 0 if all(content) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2:]))
