"""The action by which a launch file runs a scenario of tcs:

    from tcs import launch as tcs_launch
    LaunchDescription([tcs_launch.run("hover.yaml", set={"robots.drone.cpu.speed": 0.1})])

A launch file that a scenario starts, as one of its clients, is another thing: it needs nothing of this.
"""
from launch.actions import ExecuteProcess, Shutdown


def run(scenario, *, set=None, accounting=None, duration=None, out=None, options=(), **process):
    """Runs a scenario, and shuts the launch down at its end.

    scenario, and each of the values: text, a number, or what launch substitutes.
    set: values of the scenario's keys, as of --set.
    options: more options of `tcsim run`.
    process: more arguments of ExecuteProcess (on_exit, output, name ...).
    """
    command = ["tcsim", "run", scenario]
    for option, value in (("--accounting", accounting), ("--duration", duration), ("--out", out)):
        if value is not None:
            command += [option, _text(value)]
    for key, value in (set or {}).items():
        command += ["--set", [key, "=", *_parts(value)]]
    process.setdefault("output", "screen")
    process.setdefault("on_exit", Shutdown(reason="the scenario has ended"))
    process.setdefault("name", "tcsim")
    return ExecuteProcess(cmd=command + list(options), **process)


def _text(value):
    return str(value) if isinstance(value, (bool, int, float)) else value


def _parts(value):
    """What launch joins to one argument."""
    if isinstance(value, bool):
        value = "true" if value else "false"
    value = _text(value)
    return list(value) if isinstance(value, (list, tuple)) else [value]
