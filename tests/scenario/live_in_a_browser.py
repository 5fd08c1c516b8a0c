"""The checks of live_in_a_browser.sh."""
import csv
import filecmp
import os
import re
import subprocess
import sys
import time
import urllib.request

from browser import Browser
from live import PATIENCE, LiveRun

TCSIM, SCENARIO, OUT = sys.argv[1:]
MS = 1_000_000
HALF = 20 / 65535  # of the room's 15 m, and a little more


def states():
    """Time to position, of the run that nobody watched."""
    with open(f"{OUT}/plain/bodies.csv") as lines:
        return {round(float(row["time_s"]), 6): [float(row[f"{axis}_m"]) for axis in "xyz"]
                for row in csv.DictReader(lines) if row["body"] == "rover/base_footprint"}


def until(browser, script, *args):
    """What the page says once it says something; not for longer than there is a run that it may hear of. Not asked between
    pictures: a page that loads itself again meanwhile would never answer."""
    deadline = time.monotonic() + PATIENCE
    while True:
        is_over = browser.js("return ['ended', 'gone'].includes(document.querySelector('#run')?.dataset.stage)")
        if value := browser.js(script, *args):
            return value
        assert not is_over and time.monotonic() < deadline, (script, how(browser))
        time.sleep(0.03)


def end(browser):
    return browser.js("return tcs.run ? tcs.run.end : 0")


def how(browser):
    return browser.js("return document.querySelector('#run .how').textContent")


def click(browser, name):
    left, top, width, height = browser.rect(f"[data-run={name}]")
    browser.click(left + width / 2, top + height / 2)


def choose(browser, name, value):
    browser.js("""const list = document.querySelector(`[data-run=${arguments[0]}]`); list.value = arguments[1];
        list.dispatchEvent(new Event('change'));""", name, value)


def is_where_it_should_be(browser):
    """At each moment that the page has."""
    wrong = [(time, pose) for time, pose in browser.js("""const before = tcs.time, poses = [], track = tcs.run.tracks.findIndex(each => each.name === 'rover/base_footprint');
        return Array.from(tcs.run.time, time => [time, tcs.poseAt(tcs.run, track, time)]);""")
             if any(abs(a - b) > HALF for a, b in zip(pose, ROVER[round(time, 6)]))]
    assert not wrong, wrong[:3]


def pixels(browser):
    return browser.js("""const copy = document.createElement('canvas'); copy.width = 640; copy.height = 360;
        const context = copy.getContext('2d'); context.drawImage(document.querySelector('.stage canvas'), 0, 0, 640, 360);
        return [...context.getImageData(0, 0, 640, 360).data];""")


def starts_standing(browser, run):
    browser.open(run.url)
    until(browser, "return document.querySelector('#run .how').textContent.includes('paused at 0.00 of 6.00 s')")
    # Where everything is at the start is to be seen.
    until(browser, "return tcs.run && tcs.run.count === 1 && document.documentElement.dataset.firstPicture")
    is_where_it_should_be(browser)
    assert browser.js("return document.querySelector('[data-run=stand]').hidden")
    click(browser, "step")  # the usual 100 ms
    until(browser, "return tcs.run && tcs.run.end === 0.1 && document.querySelector('#run .how').textContent.includes('paused at 0.10')")
    assert run.status()["now"] == 100 * MS
    choose(browser, "by", "1000")
    click(browser, "step")
    until(browser, "return tcs.run.end === 1.1")
    assert run.stands_at(1100 * MS)
    is_where_it_should_be(browser)
    assert until(browser, "return tcs.time === 1.1"), "the page does not go with the run"


def shows_forces(browser, run):
    """Which the other run did not record: the bytes are the same. At 1.1 s the rover speeds up, and hops off its wheels."""
    click(browser, "step")
    held = until(browser, """const found = tcs.time === 2.1 ? tcs.contactsAt(tcs.run, tcs.time) : [];
        return found.length > 2 && found.filter(each => each.first.startsWith('rover/')).reduce((sum, each) => sum + each.force[2], 0);""")
    assert abs(held - 94.18) < 0.1, f"the floor holds {held} N of a rover of 9.6 kg"
    assert not browser.js("return document.querySelector('.of-forces').hidden")
    browser.after_pictures()
    before = pixels(browser)
    browser.js("document.querySelector('[data-set=forces]').click()")
    browser.after_pictures()
    assert sum(abs(a - b) > 12 for a, b in zip(before, pixels(browser))) > 10, "the arrows are not seen"
    browser.js("document.querySelector('[data-set=forces]').click()")


def goes_on(browser, run):
    before = pixels(browser)
    # So slow that it is paused before its end on any host.
    choose(browser, "pace", "0.1")
    run.until(lambda: run.status()["pace"] == 0.1)  # of two wishes at once the second may come first
    click(browser, "go")
    until(browser, "return tcs.run.end > 2.25 && tcs.time > 2.2")
    assert "The run goes on" in how(browser), how(browser)
    assert run.status()["pace"] == 0.1
    click(browser, "stand")
    until(browser, "return document.querySelector('#run .how').textContent.includes('paused at')")
    at = run.status()["now"] / 1e9
    # All that it has done until then comes, and nothing more.
    until(browser, "return arguments[0] - tcs.run.end < 0.02 && Math.abs(tcs.time - tcs.run.end) < 1e-9", at)
    assert end(browser) <= at
    browser.after_pictures()
    after = pixels(browser)
    assert sum(abs(a - b) > 12 for a, b in zip(before, after)) > 60, "the picture does not change"
    is_where_it_should_be(browser)
    said = browser.js("return [tcs.run.said.length, document.querySelectorAll('#said-lines li').length]")
    assert said[0] == said[1] > 20, said
    # Those of the programs' lines that were written by then.
    with open(f"{OUT}/plain/output.csv") as lines:
        by_then = [row for row in csv.DictReader(lines) if int(row["time_ns"]) <= (at - 0.02) * 1e9]
    assert said[0] >= len(by_then) > 20, (said, len(by_then))
    until(browser, "return /[1-9][0-9]* slices/.test(document.querySelector('#timeline output').textContent)")
    path = browser.js("return document.querySelector('#motion path.line').getAttribute('d').length")
    assert path > 200, path


def looks_back(browser, _):
    """The slider leaves the run alone, and Follow the run comes back to it."""
    left, top, width, height = browser.rect("#player input[type=range]")
    browser.click(left + width / 4, top + height / 2)
    assert not browser.js("return tcs.isFollowing") and abs(browser.js("return tcs.time / tcs.run.end") - 0.25) < 0.05
    time = browser.js("return tcs.time")
    choose(browser, "pace", "0.25")
    last = end(browser)
    click(browser, "go")
    until(browser, "return tcs.run.end > arguments[0] + 0.2", last)
    click(browser, "stand")
    assert browser.js("return tcs.time") == time
    click(browser, "follow")
    assert browser.js("return tcs.isFollowing && tcs.time > arguments[0]", time)


def small_and_dark(browser, _):
    light = pixels(browser)
    browser.resize(400, 800, mobile=True)
    browser.media(dark=True)
    browser.after_pictures()
    assert browser.js("return [document.scrollingElement.scrollWidth, innerWidth]") == [400, 400]
    until(browser, "return document.querySelector('#run').dataset.stage === 'stands'")
    for name in ("go", "step", "by", "pace", "follow"):
        left, _, width, height = browser.rect(f"[data-run={name}]")
        assert left >= 0 and left + width <= 400 and height >= 30, (name, left, width, height)
    assert sum(light[:40]) > sum(pixels(browser)[:40]) + 2000, "the world is as bright in the dark"
    browser.resize(800, 640)
    browser.media()


def ends(browser, run):
    choose(browser, "pace", "0")
    click(browser, "go")
    until(browser, "return document.querySelector('#run').dataset.stage === 'ended'")
    run.release()
    run.end()
    assert re.search(r"has ended at 6\.00 s.*tcsim view", how(browser)), how(browser)
    assert (end(browser), browser.js("return tcs.run.count")) == (6, 301), (end(browser), browser.js("return tcs.run.count"))
    is_where_it_should_be(browser)
    assert browser.js("return document.querySelector('[data-run=step]').getBoundingClientRect().height") == 0
    assert filecmp.cmp(f"{OUT}/plain/bodies.csv", f"{OUT}/run/bodies.csv", shallow=False)
    assert filecmp.cmp(f"{OUT}/plain/trace.json", f"{OUT}/run/trace.json", shallow=False)


def is_shown_again(browser):
    """By `tcsim view`: a folder that is finished, as its report; one that a run writes to, as it grows."""
    shown = subprocess.Popen([TCSIM, "view", f"{OUT}/run"], stderr=subprocess.PIPE, text=True)
    url = re.search(r"http://\S+/", shown.stderr.readline())[0]
    browser.open(url)
    browser.after_pictures()
    assert browser.js("return tcs.run.count") == 301 and browser.js("return document.querySelector('#run') === null")
    is_where_it_should_be(browser)
    shown.terminate()
    shown.wait()
    with LiveRun(TCSIM, SCENARIO, f"{OUT}/again", "--duration", "2s", "--pause") as run:
        run.control(f"step {500 * MS}")
        run.stands_at(500 * MS)
        shown = subprocess.Popen([TCSIM, "view", f"{OUT}/again"], stderr=subprocess.PIPE, text=True)
        url = re.search(r"http://\S+/", shown.stderr.readline())[0]
        browser.open(url)
        until(browser, "return tcs.run && tcs.run.end === 0.5")
        assert browser.js("return document.querySelector('[data-run=go]').hidden"), "nobody would hear it"
        run.tell("go")
        until(browser, "return document.querySelector('#run').dataset.stage === 'ended' && tcs.run.end === 2")
        is_where_it_should_be(browser)
        run.end()
        with urllib.request.urlopen(url) as answer:
            page = answer.read()
        assert b'id="replay"' in page and b'id="run"' not in page, "it has ended, and this is not its report"
    shown.terminate()
    shown.wait()


os.mkdir(f"{OUT}/profile")
plain = subprocess.Popen([TCSIM, "run", SCENARIO, "--accounting", "fixed", "--duration", "6s", "--out", f"{OUT}/plain"],
                         stdout=subprocess.DEVNULL)
with Browser(f"{OUT}/profile") as its_browser:
    assert plain.wait() == 0, plain.returncode
    ROVER = states()
    with LiveRun(TCSIM, SCENARIO, f"{OUT}/run", "--duration", "6s", "--pause", "--set", "csv_contacts=true",
                 held=True) as its_run:
        for check in (starts_standing, shows_forces, goes_on, looks_back, small_and_dark, ends):
            check(its_browser, its_run)
            print(check.__name__, flush=True)
    is_shown_again(its_browser)
    complaints = its_browser.complaints()
    assert not complaints, complaints
