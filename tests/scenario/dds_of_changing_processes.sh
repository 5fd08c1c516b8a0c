#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# A DDS program's child by fork has none of its participants: what it sends reaches nobody and
# spoils nothing of its parent's, and a warning says so once. A program that it executes begins anew,
# and if that one does not speak DDS it is missed when the lease is over.
# Topics: dds, processes, failures.
said=$("$tcsim" exec --cores 2 -- bash -c '
"$0" read & reader=$!
"$0" write && wait "$reader"' "$build/bin/changing_speaker" 2>&1) || fail "$said"
for words in 'all numbers' 'nobody writes'; do grep -qx "$words" <<<"$said" || fail "$said"; done
[[ $(grep -c '^tcsim: warning: .* sends DDS messages in a child that it has forked' <<<"$said") == 1 ]] ||
  fail "not warned, or not once: $said"
