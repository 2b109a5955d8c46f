#!/usr/bin/env bash
# Fails when a C++ file differs from what .clang-format makes of it; `scripts/check_format.sh --mend` writes it so. Generated
# files and the headers that GLSL shares are left as they are.
set -euo pipefail
cd "$(dirname "$0")/.."
formatter=$(command -v clang-format-14) || { echo "clang-format-14 is not installed; ./test installs it" >&2; exit 1; }
mode=(--dry-run -Werror)
[ "${1:-}" = --mend ] && mode=(-i)
find server tests protocol -name generated -prune -o \( -name '*.cpp' -o -name '*.h' \) -print0 | xargs -0 "$formatter" "${mode[@]}"
