# Each command and option of --help must be in the manual pages, as shown by man, and in bash's completions:
#   check_manual.py EVICAL FOLDER [EVICAL-GUI]
import os
import re
import subprocess
import sys

program, folder = sys.argv[1:3]
desktop_program = sys.argv[3] if len(sys.argv) > 3 else None
faults = []


def output(*command, **more):
    return subprocess.run(command, check=True, capture_output=True, text=True, **more)


def words(text):
    return re.sub(r"\s+", " ", text)


def page(name, folder=folder):
    shown = output("man", "--warnings", "-l", f"{folder}/man1/{name}.1",
                   env={**os.environ, "LC_ALL": "C.UTF-8", "MANWIDTH": "1000", "MANROFFOPT": "", "MANPAGER": "cat", "PAGER": "cat"})
    if shown.stderr:
        faults.append(f"{name}.1: man says {shown.stderr}")
    return words(re.sub(".\b", "", shown.stdout).replace("‐\n", ""))


def completed(*typed):
    script = ('source "$0"; COMP_WORDS=(evical "$@"); COMP_CWORD=$#; COMPREPLY=(); _evical; printf "%s\\n" "${COMPREPLY[@]}"')
    return output("bash", "-c", script, f"{folder}/completions/evical", *typed).stdout.split()


def expect(good, what):
    if not good:
        faults.append(what)


def check_command(command):
    help_text = output(program, command, "--help").stdout
    manual = page(f"evical-{command}")
    offered = completed(command, "--") + completed(command, "-")
    options = re.findall(r"^  (-\S+)(.*)$", help_text, re.MULTILINE)
    expect(options, f"{command} --help shows no option")
    for names, rest in options:
        expect(names.replace(",", ", ") in manual, f"evical-{command}.1 has no {names}")
        for name in names.split(","):
            expect(name in offered, f"{name} of {command} is not completed")
        choices = re.search(r"\{(.+?)\}", rest.split("  ")[0])
        if choices:
            expect(completed(command, names.split(",")[-1], "") == choices.group(1).split(","), f"{names} of {command} is not completed")
    for text in re.findall(r"^ {30}(\S.*)$", help_text, re.MULTILINE):
        expect(words(text) in manual, f"evical-{command}.1 does not say: {text}")
    return len(options)


help_text = output(program, "--help").stdout
commands = re.findall(r"^  ([a-z]+) ", help_text.split("Subcommands:")[1], re.MULTILINE)
expect(len(commands) > 10, f"only {commands} in --help")
manual = page("evical")
for command in commands:
    expect(re.search(rf"\b{command} ", manual) and f"evical-{command}(1)" in manual, f"evical.1 has no {command}")
    expect(command in completed(""), f"{command} is not completed")
count = sum(check_command(command) for command in commands)
pages = sorted(name.removesuffix(".1") for name in os.listdir(f"{folder}/man1"))
expect(pages == sorted(["evical"] + [f"evical-{command}" for command in commands]), f"other pages than commands: {pages}")

settings = re.findall(r"^([a-z_]+\.[a-z_.]+) ", output(program, "options", "--all").stdout, re.MULTILINE)
offered = completed("calibrate", "session.yaml", "--set", "")
manual = page("evical-options")
for setting in settings:
    expect(setting + "=" in offered, f"--set {setting} is not completed")
    expect(setting in manual, f"evical-options.1 has no {setting}")
expect(len(settings) > 50, "evical options shows none")

if desktop_program:
    help_text = output(desktop_program, "--help", env={**os.environ, "QT_QPA_PLATFORM": "offscreen"}).stdout
    manual = page("evical-gui", f"{folder}/desktop")
    options = re.findall(r"^  (-\S+(?:, -\S+)?) ", help_text, re.MULTILINE)
    expect(len(options) > 4, f"evical-gui --help shows only {options}")
    for names in options:
        if "help-all" not in names:  # Qt's own
            expect(names in manual, f"evical-gui.1 has no {names}")

print("\n".join(faults) or f"{len(commands)} commands, {count} options, {len(settings)} settings")
sys.exit(bool(faults))
