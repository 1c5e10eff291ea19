#!/bin/bash
# Prints the size of the code beside the bounds that the project keeps (docs/reference/architecture.md), and beside what
# it aims at where that is less. Exits with 1 where a bound is exceeded. A bound follows the code down, to the next hundred;
# a change that needs more raises it, and its commit says what the lines are for.
# Usage: cmake/size.sh
set -euo pipefail
cd "$(dirname "$0")/.."
exceeded=0
git ls-files -- cmake >/dev/null 2>&1 || { echo 'skipped: no checkout of git'; exit 77; }

tracked() { git ls-files -- "$@"; }
lines() { xargs -r cat 2>/dev/null | wc -l; }
# row TEXT VALUE at-most|at-least BOUND [AIM]
row() {
  local within=yes
  if [ "$3" = at-most ] && [ "$2" -gt "$4" ]; then within=no; fi
  if [ "$3" = at-least ] && [ "$2" -lt "$4" ]; then within=no; fi
  if [ $within = no ]; then exceeded=1; fi
  printf '%-58s %8d   %-8s %6d   %-3s%s\n' "$1" "$2" "$3" "$4" $within "${5:+   aim: $5}"
}

host() { tracked host | grep -E '\.(cpp|hpp)$'; }
# lengths: the number of lines of each file on standard input, ascending
lengths() { while read -r file; do wc -l <"$file"; done | sort -n; }

row 'lines of host/' "$(host | lines)" at-most 78450 58000
row 'files of host/' "$(host | wc -l)" at-most 550 520
row 'lines of host/renderer/' "$(host | grep '^host/renderer/' | lines)" at-most 36100 32000
row 'lines of the median file of host/' \
  "$(host | lengths | awk '{n[NR] = $1} END {print n[int((NR + 1) / 2)]}')" at-least 90
row 'headers of host/ under 30 lines' \
  "$(host | grep '\.hpp$' | lengths | awk '$1 < 30' | wc -l)" at-most 25
row 'public headers' "$(tracked include | grep '\.hpp$' | wc -l)" at-most 25
row 'files that name processes outside host/cluster/' \
  "$(host | grep -v '^host/cluster/' | xargs grep -lwE 'Communicator|MPI' | wc -l)" at-most 7 6
row 'lines of tests/' "$(tracked tests | grep -E '\.(cpp|hpp|py|sh)$' | lines)" at-most 55950 45000
row 'lines of bench/' "$(tracked bench | grep -E '\.(cpp|hpp|py|sh)$' | lines)" at-most 17000
row 'files below tests/' "$(tracked tests | wc -l)" at-most 1000
row 'conditional directives of kernels/' \
  "$(tracked kernels | grep -E '\.(cl|clh)$' | xargs cat | grep -cE '^ *# *(if|ifdef|ifndef|elif)')" at-most 90
exit $exceeded
