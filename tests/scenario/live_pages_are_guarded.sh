#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# The server of a live page answers whoever was given its address, and nobody else: wrong tokens, other
# origins, other hosts, garbage and floods are refused, and the run goes on all the while.
# Topics: live page, isolation.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
cd "$(dirname -- "${BASH_SOURCE[0]}")"
timeout 450 python3 -B live_pages_are_guarded.py "$tcsim" "$build/examples/rover/scenario.yaml" "$out" || fail "the server lets in whom it should not"
