#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
source "$(dirname -- "${BASH_SOURCE[0]}")/planners_world.sh"
# A planner whose next DDS sample is always there has an activation for each one that it takes, though
# it never waits, however it takes them; one that only reads samples has none for that.
# Topics: activations, dds.
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
kinds=(taking waiting loaned reading draining)
fly_planners "['$build/bin/dds_planner', KIND]"
PYTHONPATH=$source_root/tests/scenario python3 -B - "$out/out" <<'PY' || fail "$(cat "$out/said")"
import csv, sys
import planners_charges
COUNT = 30
rows = {}
for row in csv.DictReader(open(sys.argv[1] + "/activations.csv")):
    # Of the programs' first threads, from the first sample on.
    if row["thread"] == "0" and row["cause"] == "input" and int(row["start_ns"]) >= 500_000_000:
        rows.setdefault(row["client"], []).append(row)
print({client: len(of) for client, of in rows.items()})
for kind in ("taking", "waiting", "loaned"):
    got = rows[kind + "/c"]
    assert COUNT - 1 <= len(got) <= COUNT + 1, (kind, len(got))
    planners_charges.judge(kind, got[1:-1])
    for row in got[1:-1]:
        assert int(row["release_ns"]) <= int(row["start_ns"]) < int(row["end_ns"]), (kind, row)
# The one with its first wait's end, and then it computes on and on.
assert len(rows["reading/c"]) <= 2, len(rows["reading/c"])
# On a busy host it may find those of two periods.
assert COUNT * 4 // 5 <= len(rows["draining/c"]) <= COUNT + 1, len(rows["draining/c"])
PY
