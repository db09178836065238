#!/usr/bin/env bash
# Fails, and names the files, where a source is not as .clang-format has it. With --fix it rewrites them.
set -euo pipefail
cd "$(dirname "$0")/.."

# Other versions format otherwise: sources are as Debian 12's has them.
version=$(clang-format --version | sed -n 's/.*version \([0-9]*\).*/\1/p')
if [ "$version" != 14 ]; then
  echo "Format: not checked, since this is clang-format $version and sources are as version 14 has them."
  exit 0
fi

problems=$(mktemp)
trap 'rm -f "$problems"' EXIT
mapfile -t sources < <(find app core examples python $([ -d ui ] && echo ui) tests -name '*.h' -o -name '*.cpp' 2>/dev/null | sort)
if [ "${1:-}" = "--fix" ]; then
  clang-format -i "${sources[@]}"
  exit 0
fi
if ! clang-format --dry-run --Werror "${sources[@]}" 2>"$problems"; then
  sed -n 's/^\([^ :]*\):[0-9]*:[0-9]*: error.*/\1/p' "$problems" | sort -u
  echo "These files are not formatted: run packaging/check-format.sh --fix" >&2
  exit 1
fi
echo "Format: ${#sources[@]} files as .clang-format has them."
