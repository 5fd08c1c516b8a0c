#!/usr/bin/env bash
# What a user of ./dev sees of a build (.ci/progress), with a terminal and without: how far it is, the compiler's words
# when they matter, the command's exit status; and where the page is (.ci/show_page).
set -euo pipefail
root=$1
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
fail() { printf 'FAILED: %s\n' "$*" >&2; exit 1; }
export TERM=xterm LC_ALL=C
unset CI DISPLAY WAYLAND_DISPLAY SSH_CONNECTION SSH_TTY SUDO_USER

# To be called by what is shown: goes on once the terminal has shown these words, or after $1 seconds where nobody says what
# the terminal shows ($seen). Who is late sees all at once else, and shows none of it.
cat >"$out/await" <<'AWAIT'
if [[ -z ${seen:-} ]]; then exec sleep "$1"; fi
for _ in {1..600}; do
  grep -qF "$2" "$seen" && exit
  sleep 0.05
done
AWAIT

# Recorded of ninja, shortened; a build of eight steps, the fifth of which fails with $1.
cat >"$out/ninja" <<'BUILD'
#!/usr/bin/env bash
step() { echo "@$1/8@ Building CXX object part$1.o"; }
echo "ninja: Entering directory \`build'"
step 1; step 2; step 3
printf 'part3.cc:7:5: warning: unused variable\n    7 | int x;\n      |     ^\n'
step 4
bash "${0%/*}/await" "${2:-0.12}" '50 %'
if (($1)); then
  printf 'FAILED: part5.o \n/usr/bin/c++ -c part5.cc\npart5.cc:1:1: error: no type\n'
  step 6
  echo "ninja: build stopped: subcommand failed."
  exit "$1"
fi
step 5; step 6; step 7; step 8
BUILD
chmod +x "$out/ninja"
warned=$'part3.cc:7:5: warning: unused variable\n    7 | int x;\n      |     ^'

on_terminal() {  # COLUMNS COMMAND: what a terminal of that width gets
  script -qec "stty cols $1 -onlcr; $2" /dev/null </dev/null
}
watched() {  # COLUMNS COMMAND: the same, where the command waits until it is seen
  local status=0
  : >"$out/seen"
  seen=$out/seen on_terminal "$@" >"$out/seen" || status=$?
  cat "$out/seen"
  return "$status"
}
# What is left on it: of each line what follows the last time that it was erased.
left() { sed -e 's/.*\r\x1b\[K//' -e 's/\r$//'; }

# Without a terminal a short build has one line, then the warnings; ninja's steps are not among it.
said=$("$root/.ci/progress" building "$out/ninja" 0 0 2>&1) || fail "a build that succeeds: status $?"
[[ $said == "./dev: building: done in 0:"??$'\n'"$warned" ]] || fail "without a terminal: $said"

# What fails is shown whole, and the status is kept.
status=0
said=$("$root/.ci/progress" building "$out/ninja" 3 0 2>&1) || status=$?
((status == 3)) || fail "the status is $status, not 3"
for words in "$warned" "/usr/bin/c++ -c part5.cc" "part5.cc:1:1: error: no type" "build stopped"; do
  [[ $said == *"$words"* ]] || fail "'$words' is missing: $said"
done
[[ $said != *@* ]] || fail "steps are shown: $said"

# A terminal has one line that moves, and is left without it.
said=$(watched 80 "'$root/.ci/progress' --then 'the flight' '2/3 building' '$out/ninja' 0") || fail "on a terminal: $?"
# How many steps it shows depends on how fast they go, and whether it guesses the rest, too.
[[ $said =~ $'\r\e[K./dev: 2/3 building: '[0-9]+' % ('[1-7]' of 8), 0:'..(', about '[^,]*)?', then the flight' ]] || fail "no line moved: $said"
[[ $(left <<<"$said") == "./dev: 2/3 building: done in 0:"??$'\n'"$warned" ]] || fail "left on a terminal: $(left <<<"$said")"
status=0
said=$(on_terminal 80 "'$root/.ci/progress' building '$out/ninja' 3") || status=$?
((status == 3)) || fail "on a terminal the status is $status, not 3"
[[ $(left <<<"$said") == *"error: no type"*"build stopped"* ]] || fail "on a terminal: $said"

# The line never wraps.
said=$(watched 30 "'$root/.ci/progress' building '$out/ninja' 0")
longest=$(tr '\r' '\n' <<<"$said" | sed -n 's/^\x1b\[K//p' | awk '{ if (length > m) m = length } END { print m + 0 }')
((longest > 20 && longest < 30)) || fail "the longest line on 30 columns has $longest"

# A dumb terminal has no line that moves.
said=$(TERM=dumb on_terminal 80 "'$root/.ci/progress' building '$out/ninja' 0")
[[ $said != *$'\e'* && $said == *"done in"* ]] || fail "on a dumb terminal: $said"

# apt-get tells how far it is, and what it prints is shown only where it fails, the end of it.
cat >"$out/apt" <<'APT'
printf 'Reading package lists...\ndlstatus:1:40.0:Retrieving file 1 of 2\nGet:1 libfoo\n'
bash "${0%/*}/await" "${2:-0.12}" '40 %'
printf 'pmstatus:libfoo:amd64:75.0000:Unpacking libfoo\nE: the disk is full\n'
bash "${0%/*}/await" "${2:-0.12}" '75 %'
exit "$1"
APT
said=$(watched 80 "'$root/.ci/progress' --quiet installing bash '$out/apt' 0")
[[ $said == *"installing: fetching 40 %"*"installing: setting up 75 %"* ]] || fail "apt-get on a terminal: $said"
[[ $(left <<<"$said") == "./dev: installing: done in 0:"?? ]] || fail "apt-get is not quiet: $said"
said=$("$root/.ci/progress" --quiet --last 1 installing bash "$out/apt" 9 0 2>&1) && fail "apt-get's status is lost"
[[ $said == "E: the disk is full" ]] || fail "apt-get failed and said: $said"

# ^C ends the build at once, with the status that shells know, and leaves a clean line.
: >"$out/said"
presses_it() {
  local _
  for _ in {1..1000}; do
    grep -q '(4 of 8)' "$out/said" && break
    sleep 0.05
  done
  printf '\003'
}
presses_it | script -qec "'$root/.ci/progress' building '$out/ninja' 0 20" /dev/null >"$out/said" && fail "^C: status 0"
[[ $(left <"$out/said") == *"./dev: interrupted" ]] || fail "after ^C: $(cat "$out/said")"
! grep -q 'done in' "$out/said" || fail "^C did not end the build"

# The page: a link, and opened only before somebody who sits there.
mkdir "$out/bin" "$out/a page"
cat >"$out/bin/xdg-open" <<OPEN
#!/bin/sh
echo "\$1" >'$out/opened'
OPEN
chmod +x "$out/bin/xdg-open"
touch "$out/a page/ü.html"
export PATH="$out/bin:$PATH"
link="file://$out/a%20page/%C3%BC.html"
show="'$root/.ci/show_page' '$out/a page/ü.html'"
said=$(DISPLAY=:7 "$root/.ci/show_page" "$out/a page/ü.html" 2>&1)
[[ $said == *": $link" ]] || fail "the page is at $said"
on_terminal 200 "$show" >/dev/null
DISPLAY=:7 CI=true on_terminal 200 "$show" >/dev/null
DISPLAY=:7 SSH_TTY=/dev/pts/1 on_terminal 200 "$show" >/dev/null
sleep 0.1
[[ ! -e $out/opened ]] || fail "the page was opened where nobody sits"
said=$(DISPLAY=:7 on_terminal 200 "$show")
[[ $said == *": $link" ]] || fail "the page that is opened is at $said"
for _ in {1..1000}; do [[ -s $out/opened ]] && break; sleep 0.05; done
[[ $(cat "$out/opened") == "$link" ]] || fail "the page was not opened"
