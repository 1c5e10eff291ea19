#!/bin/bash
# Manual pages and completions say what --help says, and the shells take them.
#   manuals.sh PHOTILE SOURCE-FOLDER SCRATCH-FOLDER
set -eu
photile=$1 source=$2 scratch=$3/manuals
mkdir -p "$scratch"

fail() {
  echo "manuals.sh: $*" >&2
  exit 1
}

commands=$("$photile" --help | sed -n '/^Subcommands:/,$s/^  \([a-z]*\) .*/\1/p')
[ "$(wc -w <<< "$commands")" -ge 10 ] || fail "--help lists no commands"
"$photile" --manual photile > "$scratch/photile.1"
for command in $commands; do
  grep -qx "\\\\fB$command\\\\fR" "$scratch/photile.1" || fail "photile.1 lacks $command"
  "$photile" --manual "$command" > "$scratch/photile-$command.1"
  # Every option of the help has an entry.
  "$photile" "$command" --help | grep -o '^  -[^ ]*' | tr ',' '\n' | tr -d ' ' |
    while read -r option; do
      grep -qF -- "\\fB${option//-/\\-}\\fR" "$scratch/photile-$command.1" ||
        fail "photile-$command.1 lacks $option"
    done
  if command -v groff > /dev/null; then
    warnings=$(groff -man -Tutf8 -ww -W break -z "$scratch/photile-$command.1" 2>&1)
    [ -z "$warnings" ] || fail "photile-$command.1: $warnings"
  fi
done
! "$photile" --manual paint 2> "$scratch/error" || fail "a page of no command"
grep -q "there is no command 'paint'" "$scratch/error" || fail "the error does not name it"

for shell in bash zsh fish; do
  "$photile" --completion $shell > "$scratch/photile.$shell"
  if command -v $shell > /dev/null; then
    $shell -n "$scratch/photile.$shell" || fail "$shell does not take its completion"
  else
    echo "not run: there is no $shell here"
  fi
done
! "$photile" --completion tcsh 2> /dev/null || fail "a completion for tcsh"

# offers WORD LINE...: what bash offers after a command line.
offers() {
  local wanted=$1
  shift
  bash -c '. "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _photile
    printf "%s\n" "${COMPREPLY[@]}"' _ "$scratch/photile.bash" "$@" | grep -qxe "$wanted" ||
    fail "bash does not offer $wanted after: $*"
}
offers render photile re
offers --photons photile render --pho
offers final photile render --quality f
offers --version photile --v

if command -v desktop-file-validate > /dev/null; then
  desktop-file-validate "$source/cmake/packaging/org.photile.Photile.desktop"
fi
if command -v appstreamcli > /dev/null; then
  appstreamcli validate --no-net "$source/cmake/packaging/org.photile.Photile.metainfo.xml" > /dev/null ||
    fail "the AppStream entry is not valid"
fi
echo "pages of $(wc -w <<< "$commands") commands, completions of three shells"
