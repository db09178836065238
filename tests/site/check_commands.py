# SPDX-License-Identifier: BSD-3-Clause
"""Commands in documents must match the program: its help has each command, option and setting, files of the repository that
they name exist, boards can be drawn, and complete sessions are valid: check_commands.py SOURCE SCRATCH EVICAL [EVICAL-GUI]"""
import os
import re
import shlex
import subprocess
import sys

root, scratch, program = sys.argv[1:4]
desktop_program = sys.argv[4] if len(sys.argv) > 4 else None
os.makedirs(scratch, exist_ok=True)
faults, seen, boards, sessions = [], 0, 0, 0


def output(*command):
    ran = subprocess.run(command, capture_output=True, text=True, env={**os.environ, "QT_QPA_PLATFORM": "offscreen"})
    return ran.stdout if ran.returncode == 0 else None


def options_in(help_text):
    return set(re.findall(r"(?<![\w-])--?[A-Za-z][\w-]*", help_text))


settings = set(re.findall(r"^([a-z_]+\.[a-z0-9_.]+) ", output(program, "options", "--tuning"), re.MULTILINE))
groups = {"tuning"} | {setting.removeprefix("tuning.").split(".")[0] for setting in settings}
short_names = {".".join([parts[0], parts[2]]) for parts in (setting.split(".") for setting in settings) if len(parts) == 3}
commands = re.findall(r"^  ([a-z]+) ", output(program, "--help").split("Subcommands:")[1], re.MULTILINE)
options = {command: options_in(output(program, command, "--help")) for command in commands}
options["options"].add("--tuning")  # for developers: not in its help
options[""] = options_in(output(program, "--help"))


def check(line, where):
    """One command line, from the program's name on."""
    global seen, boards
    words = shlex.split(line.split(" # ")[0].split("|")[0].split("&&")[0].split(">")[0])
    seen += 1
    if os.path.basename(words[0]) == "evical-gui":
        known = options_in(output(desktop_program, "--help")) if desktop_program else None
        faults.extend(f"{where}: evical-gui has no {word}" for word in words if known and word.startswith("-") and word not in known)
        return
    command = words[1] if len(words) > 1 else ""
    if command and not command.startswith("-") and command not in commands:
        if command != "gui" and re.fullmatch("[a-z]+", command):
            faults.append(f"{where}: there is no evical {command}")
        return
    for index, word in enumerate(words[2:], 2):
        name = word.split("=")[0]
        if re.match(r"--?[A-Za-z]", word) and name not in options[command if command in commands else ""]:
            faults.append(f"{where}: evical {command} has no {name}: {line}")
        if word.startswith("config/") and not os.path.exists(f"{root}/{word}"):
            faults.append(f"{where}: {word} does not exist")
    if command == "board" and re.search(r"-o \S+\.(pdf|svg|html)$", line.split(" # ")[0].strip()):
        boards += 1
        ran = subprocess.run([program, *words[1:]], cwd=scratch, capture_output=True, text=True)
        if ran.returncode != 0:
            faults.append(f"{where}: {line}: {ran.stderr.strip()}")


def check_session(text, where):
    """A session is valid if the program's only objection is the empty recording. Lines that name further files are omitted."""
    global sessions
    sessions += 1
    with open(f"{scratch}/session.yaml", "w", encoding="utf-8") as session:
        session.write("\n".join(line for line in text.split("\n") if ".yaml" not in line))
    open(f"{scratch}/recording.bag", "w").close()
    ran = subprocess.run([program, "detect", "session.yaml", "-o", "detected"], cwd=scratch, capture_output=True, text=True)
    if "recording.bag: the file is empty" not in ran.stderr:
        faults.append(f"{where}: session: {ran.stderr.strip()}")


documents = [f"{root}/{name}" for name in ("README.md", "CONTRIBUTING.md")]
documents += [f"{root}/docs/{name}" for name in sorted(os.listdir(f"{root}/docs")) if name.endswith(".md")]
for document in documents:
    with open(document, encoding="utf-8") as file:
        text = file.read()
    where = os.path.relpath(document, root)
    for session in re.findall(r"^```yaml\n(evical_session: 1\n.*?)^```", text, re.MULTILINE | re.DOTALL):
        check_session(session, where)
    code = re.findall(r"^```[^\n]*\n(.*?)^```", text, re.MULTILINE | re.DOTALL) + re.findall(r"^ {4}(.*)$", text, re.MULTILINE)
    typed = re.findall(r"^((?:build/\w+/)?evical(?:-gui)? .*)$", "\n".join(code), re.MULTILINE)
    typed += re.findall(r"(?<!`)`((?:build/\w+/)?evical(?:-gui)? [^`\n]+)`(?!`)", text)
    for line in typed:
        try:
            check(re.sub(r"\[.*?\]|\.\.\.", "", line), where)
        except ValueError as problem:
            faults.append(f"{where}: {line}: {problem}")
    in_yaml = re.findall(r"[{,\s]([a-z_]+(?:\.[a-z0-9_]+)+): ", "\n".join(re.findall(r"^```yaml\n(.*?)^```", text, re.MULTILINE | re.DOTALL)))
    for line in in_yaml + re.findall(r"--set[ =]([a-z_]+\.[\w.]+)=", text) + re.findall(r"`([a-z_]+\.[a-z_]+(?:\.[a-z_]+)?)(?:[=:] ?[^`]*)?`", text):
        is_setting = line.split(".")[0] in groups and not re.search(r"\.(yaml|csv|h|cpp|md|py|bag|html|txt)$", line)
        if is_setting and line not in settings | short_names and not any(known.startswith(line + ".") for known in settings):
            faults.append(f"{where}: there is no option {line}")
if seen < 60 or boards < 5 or sessions < 2:
    faults.append(f"only {seen} commands, {boards} boards and {sessions} sessions were found")
print("\n".join(faults) or f"{len(documents)} documents, {seen} commands, {boards} boards drawn, {sessions} sessions")
sys.exit(bool(faults))
