#!/usr/bin/env bash
# Fails, and names the places, where clang-tidy finds something in core, app, ui or python: packaging/check-tidy.sh [SOURCE...]. Needs a
# configured build/ci. EVICAL_TIDY_TIMES=1 shows what it spends its time on.
set -euo pipefail
cd "$(dirname "$0")/.."

[ -f build/ci/compile_commands.json ] || cmake --preset ci >/dev/null
python3 packaging/tidy_groups.py build/ci "$@"
