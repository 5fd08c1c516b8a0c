"""What planners that compute 15 ms for each message, by their own clocks, are charged for it."""


def judge(kind, rows):
    """Fails where the activations `rows` of the planner were charged too little or too much.

    After a thread was charged too much, on a busy host, its own clock goes on at half its rate at least while it is charged
    nothing: a single activation may have half of what it computed, and the next ones the rest.
    """
    charged = [int(row["charged_ns"]) for row in rows]
    assert 14_500_000 < sum(charged) / len(charged) < 40_000_000, (kind, charged)
    for row in rows:
        assert 7_500_000 < int(row["charged_ns"]) < 80_000_000, (kind, row)
