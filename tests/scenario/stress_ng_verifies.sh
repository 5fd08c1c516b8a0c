#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# stress-ng checks for itself what its stressors get: those that wait. It ends by itself, after so
# many operations or so much virtual time.
# Topics: ordinary programs.
expect_verified() {
  local said accounting
  for accounting in measured fixed; do
    said=$(timeout 150 "$tcsim" exec --accounting "$accounting" -- stress-ng --verify "$@" 2>&1) ||
      fail "$accounting: stress-ng $*: $said"
    [[ $said == *"successful run completed"* && $said != *unsuccessful* && $said != *fail:* ]] ||
      fail "$accounting: stress-ng $*: $said"
  done
}
expect_verified --poll 1 --poll-ops 2000 -t 10
expect_verified --switch 1 --switch-ops 5000 -t 10
expect_verified --sem 1 --sem-ops 5000 -t 10
expect_verified --futex 1 --futex-ops 20 -t 10
expect_verified --mq 1 --mq-ops 100 -t 10
expect_verified --sem-sysv 1 --sem-sysv-ops 1000 -t 10
expect_verified --msg 1 --msg-ops 1000 -t 10
expect_verified --timer 1 --timer-ops 1000 -t 10
said=$("$tcsim" exec --accounting fixed -- stress-ng --verify --poll 1 -t 1 2>&1)
[[ $said =~ "successful run completed in 1.00"\ ?s ]] || fail "a virtual second: $said"
