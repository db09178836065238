#!/usr/bin/env bash
# Fails and lists the files if sources do not conform to .clang-format. With --fix it rewrites them.
set -euo pipefail
cd "$(dirname "$0")/.."

# Other versions format differently: the sources follow the version of Debian 12.
version=$(clang-format --version | sed -n 's/.*version \([0-9]*\).*/\1/p')
if [ "$version" != 14 ]; then
  echo "Format: not checked, since this is clang-format $version and the sources follow version 14."
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
echo "Format: ${#sources[@]} files conform to .clang-format."
