#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# kill -9 of every party of a run, at random instants. A third argument is how often, instead of once.
# Topics: clean-up, failures.
exec python3 "$source_root/tests/scenario/whoever_is_killed.py" "$tcsim" "$build/bin" "${3:-1}"
