#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# An installed tree is all that a user needs, wherever it has been moved to: the first flight, programs of a project
# that finds it, the manual pages and completions.
# Topics: packages.
work=$(mktemp -d)
trap 'wait; rm -rf "$work"' EXIT
cmake --install "$build" --prefix "$work/made" >"$work/installed" 2>&1 || fail "$(tail -n 5 "$work/installed")"
mv "$work/made" "$work/prefix"
prefix=$work/prefix
installed=$prefix/bin/tcsim
# Nothing of the build tree is used: neither by the program nor by what it starts.
grep -rlF -- "$build" "$prefix" >"$work/names" && fail "these name the build tree: $(cat "$work/names")"

[[ $("$installed" --version) == "tcsim "[0-9]* ]] || fail "there is no version: $("$installed" --version)"
[[ $("$installed" exec -- sh -c 'echo $LD_PRELOAD') == "$prefix"/lib*/tcs/libtcs_preload.so ]] ||
  fail "the shim is not the installed one: $("$installed" exec -- sh -c 'echo $LD_PRELOAD')"

cd "$work"
cat >marks.yaml <<'END'
duration: 1s
robots: {r: {clients: {loop: {command: [./by_pkg_config]}}}}
END
# These take a second or two each, and are looked at further below.
PATH=$prefix/bin:$PATH "$source_root/.ci/zsh_completes" --from "$prefix/share/zsh/vendor-completions" >zsh_said 'tcsim ru' \
  'tcsim run --accounting m' 'tcsim run --accounting=m' 'tcsim exec -- basena' 'tcsim check marks.ya' &
completes=$!
{ cmake -G Ninja -S "$source_root/tests/scenario/outside" -B outside -DCMAKE_PREFIX_PATH="$prefix" && cmake --build outside; } >outside_said 2>&1 &
builds=$!

# From nothing.
for language in python c; do
  "$installed" new --language $language $language >"$work/said" || fail "tcsim new: $(cat "$work/said")"
  (
    cd $language
    [[ $language == python ]] || cc -O2 -Wall -Werror controller.c -o controller || fail "the controller does not compile"
    "$installed" check >/dev/null || fail "the new scenario is not sound"
    "$installed" run --accounting fixed >/dev/null || fail "the new scenario does not run"
    tail -n 1 out/bodies.csv | awk -F, '{exit !($3^2 + $4^2 + ($5-1)^2 < 0.01^2)}' ||
      fail "the drone does not hover one metre high: $(tail -n 1 out/bodies.csv)"
    "$installed" run --accounting fixed --view >/dev/null 2>said && grep -q "^tcsim: watch the run at http" said ||
      fail "the new scenario cannot be watched: $(cat said)"
    schema=$(sed -n 's/^# yaml-language-server: \$schema=//p' scenario.yaml)
    [[ -f $schema && $schema == "$prefix"/* ]] || fail "the scenario's schema is not the installed one: $schema"
  )
done
! "$installed" new c 2>"$work/said" || fail "tcsim new writes into a folder that is there"
grep -q "'c' exists already" "$work/said" || fail "it says instead: $(cat "$work/said")"

# A project of somebody else's, by CMake and by pkg-config.
wait "$builds" || fail "the project outside does not build: $(tail -n 5 outside_said)"
PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name tcs.pc)") pkg-config --cflags --libs tcs >"$work/flags"
cc "$source_root/tests/scenario/outside/marks.c" $(cat "$work/flags") -o by_pkg_config ||
  fail "what pkg-config says does not build: $(cat "$work/flags")"

# What is shared is as old as it is, to the instant; without a word of it, up to the drift bound.
[[ $(outside/shared_memory) == "by itself, wrong "* ]] || fail "by itself it believes to be in a run"
ordered=$("$installed" exec --cores 2 --accounting fixed -- outside/shared_memory)
[[ $ordered == "in a run, wrong 0" ]] || fail "shared memory is not ordered: $ordered"
unordered=$("$installed" exec --cores 2 --accounting fixed -- outside/shared_memory unordered)
[[ $unordered =~ ^"in a run, wrong "[1-9] ]] || fail "the test does not see what is out of order: $unordered"

"$installed" run --accounting fixed --out marks marks.yaml >/dev/null || fail "what marks its activations fails"
activations=$(grep -c '^r/loop,\|,r/loop,' marks/activations.csv)
# The first one begins with the program.
((activations == 11)) || fail "ten marks made $activations activations"

# What is generated says what the command line does.
for command in $("$installed" --help | sed -n '/^Commands/,/^$/s/^  \([a-z]\+\) .*/\1/p'); do
  page=$prefix/share/man/man1/tcsim-$command.1
  [[ -f $page ]] || fail "there is no manual page of $command"
  for option in $("$installed" "$command" --help | grep -o '^  --[a-z-]*'); do
    grep -q -- "${option//-/\\\\-}" "$page" || fail "the page of $command lacks $option"
  done
  ! type mandoc >/dev/null 2>&1 || mandoc -T lint -W error "$page" || fail "the page of $command is not sound"
done
complete_of() {  # WORDS...: what bash completes behind them
  bash --norc -c 'source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _tcsim; echo "${COMPREPLY[*]}"' \
    bash "$prefix/share/bash-completion/completions/tcsim" "$@"
}
[[ $(complete_of tcsim ru) == run ]] || fail "bash completes 'tcsim ru' to: $(complete_of tcsim ru)"
[[ $(complete_of tcsim run --acc) == --accounting ]] || fail "bash completes an option to: $(complete_of tcsim run --acc)"
[[ $(complete_of tcsim run --accounting m) == measured ]] || fail "bash completes no values"
[[ $(complete_of tcsim run --accounting = m) == measured ]] || fail "bash completes no values behind a sign"
wait "$completes" || fail "zsh completes nothing: $(cat zsh_said)"
printf '%s \n' 'tcsim run' 'tcsim run --accounting measured' 'tcsim run --accounting=measured' 'tcsim exec -- basename' \
  'tcsim check marks.yaml' | diff - zsh_said || fail "zsh completes otherwise"

# Help fits the terminal.
for width in 60 100; do
  longest=$(script -qec "stty cols $width; $installed run --help" /dev/null | sed 's/\x1b\[[0-9;]*m//g; s/\r//' | awk '{ if (length > m) m = length } END { print m }')
  ((longest <= width)) || fail "help is $longest columns wide on a terminal of $width"
done
