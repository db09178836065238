"""The command line, for comparisons."""

import os
import subprocess


def program_output(*arguments):
    return subprocess.run([program_output.path, *map(str, arguments)], check=True, capture_output=True, text=True).stdout


program_output.path = os.environ["EVICAL_PROGRAM"]
