"""The checks of replay_in_a_browser.sh, on the pages rover.html, talk.html and crates.html of the folder that is given."""
import base64
import csv
import json
import math
import sys

from browser import Browser

FOLDER = sys.argv[1]
HALF = 20 / 65535  # of the room's 15 m, and a little more


def bodies(run, name):
    """Time to position."""
    with open(f"{FOLDER}/{run}/bodies.csv") as lines:
        return {round(float(row["time_s"]), 6): [float(row[f"{axis}_m"]) for axis in "xyz"]
                for row in csv.DictReader(lines) if row["body"] == name}


ROVER = bodies("rover", "rover/base_footprint")


def is_at(browser, seconds, name="rover/base_footprint", states=ROVER):
    """The page says that it is where bodies.csv has it."""
    pose = browser.js("return tcs.pose(arguments[0])", name)
    assert all(abs(a - b) < HALF for a, b in zip(pose, states[round(seconds, 6)])), (seconds, pose)


def now(browser):
    return browser.js("return tcs.time")


def pixels(browser):
    """The picture, small: 160 by 90 colours."""
    return browser.js("""const copy = document.createElement('canvas'); copy.width = 160; copy.height = 90;
        const context = copy.getContext('2d'); context.drawImage(document.querySelector('.stage canvas'), 0, 0, 160, 90);
        return [...context.getImageData(0, 0, 160, 90).data];""")


def changed(before, after):
    return sum(any(abs(before[i + k] - after[i + k]) > 12 for k in range(3)) for i in range(0, len(before), 4))


def the_world(browser):
    browser.open(f"{FOLDER}/rover.html")
    browser.after_pictures()
    assert browser.js("return document.documentElement.dataset.firstPicture"), "there is no picture"
    assert browser.js("return document.querySelector('#verdict h2').getBoundingClientRect().top < 300"), "the verdict comes first"
    names = browser.js("return tcs.run.robots.map(robot => robot.name)")
    assert names == ["rover", "crowd"], names
    # The wheels turn, and so are tracks; what is fixed to the base is none.
    tracks = browser.js("return tcs.run.tracks.map(track => track.name)")
    assert "rover/left_wheel" in tracks and "rover/lidar_link" not in tracks, tracks
    for seconds in (0, 1.5, 3.98):
        browser.js("tcs.seek(arguments[0])", seconds)
        is_at(browser, seconds)
    # Between two moments it is between them.
    browser.js("tcs.seek(2.01)")
    x = browser.js("return tcs.pose('rover/base_footprint')[0]")
    assert abs(x - (ROVER[2.0][0] + ROVER[2.02][0]) / 2) < HALF, x


def the_picture(browser):
    """Where the robot is said to be are pixels of its colour, and they go with it."""
    colour = browser.js("return getComputedStyle(document.documentElement).getPropertyValue('--s0')").strip()
    hue = [int(colour[i:i + 2], 16) for i in (1, 3, 5)]
    assert hue[0] > hue[2] + 60, colour
    seen = """const canvas = document.querySelector('.stage canvas'), at = tcs.view.project(0);
        const copy = document.createElement('canvas'); copy.width = canvas.width; copy.height = canvas.height;
        const context = copy.getContext('2d'); context.drawImage(canvas, 0, 0);
        const scale = canvas.width / canvas.clientWidth, x = Math.round(arguments[0][0] * scale), y = Math.round(arguments[0][1] * scale);
        const data = context.getImageData(x - 4, y - 4, 9, 9).data; let count = 0;
        for (let i = 0; i < data.length; i += 4) count += data[i] > data[i + 2] + 50;
        return count;"""
    where = "const at = tcs.view.project(tcs.run.robots[0].root); return [at.x, at.y];"
    browser.js("tcs.view.options.trails = false; tcs.seek(0)")
    first = browser.after_pictures(where)
    assert browser.js(seen, first) > 8, "the robot is not where it should be seen"
    before = pixels(browser)
    browser.js("tcs.seek(3.9)")
    second = browser.after_pictures(where)
    assert math.dist(first, second) > 30, (first, second)
    assert browser.js(seen, second) > 8 and browser.js(seen, first) < 8, "the robot stays behind"
    assert changed(before, pixels(browser)) > 20
    browser.js("tcs.view.options.trails = true")


def slider_and_keys(browser):
    left, top, width, height = browser.rect("#player input[type=range]")
    browser.click(left + width / 2, top + height / 2)
    assert abs(now(browser) - 2) < 0.05, now(browser)
    browser.js("document.activeElement.blur(); tcs.seek(1)")
    browser.keys(".")
    assert abs(now(browser) - 1.02) < 1e-9, now(browser)
    browser.keys(",", ",")
    assert abs(now(browser) - 0.98) < 1e-9, now(browser)
    is_at(browser, 0.98)
    # So slowly that it is not at its end before it is to stop, however long the test has to wait.
    browser.js("tcs.setSpeed(0.01)")
    browser.keys(" ")
    assert browser.js("return tcs.isPlaying")
    for _ in range(100):
        if now(browser) > 0.98:
            break
        browser.after_pictures()
    assert now(browser) > 0.98, "it does not play"
    browser.keys(" ")
    stands = now(browser)
    browser.after_pictures()
    assert not browser.js("return tcs.isPlaying") and now(browser) == stands
    browser.js("tcs.setSpeed(1)")
    browser.keys("\ue011")  # Home
    assert now(browser) == 0
    # On the slider, arrows are moments.
    browser.js("document.querySelector('#player input[type=range]').focus()")
    browser.keys("\ue014", "\ue014")
    assert abs(now(browser) - 0.04) < 1e-9, now(browser)
    # On the stage they turn the world.
    before = browser.js("document.querySelector('.stage').focus(); return tcs.view.orbit.turn")
    browser.keys("\ue014")
    assert browser.js("return tcs.view.orbit.turn") != before and abs(now(browser) - 0.04) < 1e-9
    left, top, width, height = browser.rect(".stage")
    browser.mouse(("move", left + width / 2, top + height * 0.8), ("down",), ("move", left + width / 2 + 100, top + height * 0.8), ("up",))
    assert abs(browser.js("return tcs.view.orbit.turn") - before) > 0.5
    browser.js("document.querySelector('[data-look=top]').click()")
    assert browser.js("return tcs.view.orbit.height") > 1.5


def speed(browser):
    """Pictures that are a tenth of a second apart, of which the test makes the clock."""
    went = browser.js("""const pictures = [], real = window.requestAnimationFrame, went = [];
        window.requestAnimationFrame = picture => pictures.push(picture);
        for (const speed of ['0.1', '1', '5']) {
          const speeds = document.querySelector('#player select');
          speeds.value = speed;
          speeds.dispatchEvent(new Event('change'));
          tcs.seek(0);
          // None is lost: the page waits for those that it has asked for, and asks for no more.
          pictures.splice(0).forEach(picture => picture(performance.now()));
          const begin = performance.now();
          tcs.play();
          for (const at of [100, 200]) pictures.splice(0).forEach(picture => picture(begin + at));
          const before = tcs.time;
          for (const at of [300]) pictures.splice(0).forEach(picture => picture(begin + at));
          went.push(tcs.time - before);
          tcs.pause();
        }
        window.requestAnimationFrame = real;
        pictures.splice(0).forEach(picture => real(picture));
        tcs.setSpeed(1);
        return went;""")
    assert all(abs(a - b) < 1e-9 for a, b in zip(went, (0.01, 0.1, 0.5))), went


def timeline(browser):
    """A click moves the world there, and who computes then is lit."""
    with open(f"{FOLDER}/rover/dispatches.csv") as lines:
        slices = [(row["row"], int(row["virtual_start_ns"]) / 1e9, int(row["virtual_end_ns"]) / 1e9) for row in csv.DictReader(lines)]
    left, top, width, _ = browser.rect("#timeline .live")
    lane = browser.js("const r = document.querySelector('#timeline .live rect.lane').getBoundingClientRect(); return [r.left, r.top, r.width];")
    browser.click(lane[0] + lane[2] * 0.5, lane[1] + 5)
    assert abs(now(browser) - 2) < 0.02, now(browser)
    longest = max((s for s in slices if s[0] == "rover/local_planner"), key=lambda s: s[2] - s[1])
    lit = """tcs.seek(arguments[0]); return [[...document.querySelectorAll('#timeline g.is-lit text.note')].map(text => text.textContent),
        document.querySelector('#replay .computing').textContent];"""
    browser.js("tcs.seek(0)")
    rows, words = browser.js(lit, (longest[1] + longest[2]) / 2)
    assert "rover/local_planner" in rows and "rover/local_planner" in words, (rows, words, longest)
    browser.js("tcs.seek(0)")
    quiet = next(t for t in (1 + i * 0.0007 for i in range(1000))
                 if not any(s[1] - 1e-5 <= t <= s[2] + 1e-5 for s in slices if s[0] == "rover/local_planner"))
    rows, words = browser.js(lit, quiet)
    assert "rover/local_planner" not in rows and "rover/local_planner" not in words, (rows, words, quiet)


def rays(browser):
    browser.js("tcs.seek(1)")
    before = browser.after_pictures() or pixels(browser)
    browser.js("document.querySelector('[data-set=rays]').click()")
    browser.after_pictures()
    differ = changed(before, pixels(browser))
    state = browser.js("""const canvas = document.querySelector('.stage canvas'), gl = canvas.getContext('webgl2') || canvas.getContext('webgl');
        return [tcs.time, document.querySelector('[data-set=rays]').checked, gl && gl.isContextLost()];""")
    assert differ > 100, ("the lidar's rays are not seen", differ, state, browser.complaints())
    browser.js("document.querySelector('[data-set=rays]').click()")


def lost_picture(browser):
    """A graphics process that dies takes it; it comes again."""
    before = browser.after_pictures() or pixels(browser)
    browser.js("""const canvas = document.querySelector('.stage canvas');
        window.lost = (canvas.getContext('webgl2') || canvas.getContext('webgl')).getExtension('WEBGL_lose_context');
        window.lost.loseContext();""")
    browser.after_pictures()
    assert changed(before, pixels(browser)) > 1000, "the picture was not lost"
    # Who listens only once it is asked for may miss it.
    browser.call("/execute/async", {"args": [], "script": """const done = arguments[0];
        document.querySelector('.stage canvas').addEventListener('webglcontextrestored', () => requestAnimationFrame(() => requestAnimationFrame(done)));
        setTimeout(() => window.lost.restoreContext(), 50);"""})
    assert changed(before, pixels(browser)) < 20, "the picture is not there again"


# Where on the stage the colour of forces is: how many pixels, and the least and the most of their places, across
# and down.
ARROWS = """const canvas = document.querySelector('.stage canvas'), width = canvas.clientWidth, height = canvas.clientHeight;
    const copy = document.createElement('canvas'); copy.width = width; copy.height = height;
    const context = copy.getContext('2d'); context.drawImage(canvas, 0, 0, width, height);
    const hex = getComputedStyle(document.documentElement).getPropertyValue('--force').trim();
    const colour = [1, 3, 5].map(i => parseInt(hex.slice(i, i + 2), 16));
    const data = context.getImageData(0, 0, width, height).data;
    let count = 0, left = 1e9, right = 0, top = 1e9, bottom = 0;
    for (let y = 0; y < height; ++y) for (let x = 0; x < width; ++x) {
      const at = 4 * (y * width + x);
      if (Math.abs(data[at] - colour[0]) + Math.abs(data[at + 1] - colour[1]) + Math.abs(data[at + 2] - colour[2]) > 90) continue;
      ++count; left = Math.min(left, x); right = Math.max(right, x); top = Math.min(top, y); bottom = Math.max(bottom, y);
    }
    return {count, left, right, top, bottom};"""


def forces(browser):
    """Arrows that hold a crate up, as long as the scale says, from the floor into the crate; two ways between two crates."""
    browser.open(f"{FOLDER}/crates.html")
    browser.js("tcs.view.options.trails = tcs.view.options.names = false; document.querySelector('[data-look=side]').click(); tcs.seek(0.3)")
    assert browser.after_pictures(ARROWS)["count"] == 0, "forces are shown before somebody asks"
    assert browser.js("return document.querySelector('.force-scale').hidden")
    before = pixels(browser)
    left, top, width, height = browser.rect("[data-set=forces]")
    browser.click(left + width / 2, top + height / 2)
    shown = browser.after_pictures(ARROWS)
    assert changed(before, pixels(browser)) > 12 and shown["count"] > 100, shown
    at = "return tcs.contactsAt(tcs.run, tcs.time).map(c => [c.first, c.second, c.force[2]])"
    found = browser.js(at)
    assert all(first == "crate" and second == "floor" and up > 0 for first, second, up in found), found
    assert abs(sum(up for *_, up in found) - 2 * 9.81) < 0.02 * 2 * 9.81, found
    # From the side: from the floor upwards, and nothing below it.
    floor = browser.js("return tcs.view.project(0, -0.2).y")
    assert abs(shown["bottom"] - floor) < 12 and shown["top"] < floor - 20, (shown, floor)
    # The scale says how long a round force is.
    bar, text = browser.js("const s = document.querySelector('.force-scale'); return [s.querySelector('i').getBoundingClientRect().width, s.textContent]")
    newtons = float(text.split("\u00a0N")[0])
    longest = max(up for *_, up in found)
    wanted = bar / newtons * longest
    # Near arrows are longer than far ones, and stand lower.
    assert 0.7 * wanted < shown["bottom"] - shown["top"] < 2 * wanted, (shown, bar, newtons, longest)
    # The lid falls, and then pushes the crate as hard as the crate holds it up.
    browser.js("tcs.seek(1.8)")
    found = browser.js(at)
    assert {(first, second) for first, second, _ in found} == {("crate", "floor"), ("crate", "lid")}, found
    assert abs(sum(up for _, second, up in found if second == "floor") - 3 * 9.81) < 0.05 * 9.81, found
    assert abs(sum(up for _, second, up in found if second == "lid") + 9.81) < 0.05 * 9.81, found
    between = browser.js("return tcs.view.project(0, 0.2).y")
    both = browser.after_pictures(ARROWS)
    assert both["top"] < between - 5 < between + 5 < both["bottom"], (both, between)
    # In the dark and at 400 pixels they are there, too.
    browser.media(dark=True)
    browser.resize(400, 800, mobile=True)
    small = browser.after_pictures(ARROWS)
    assert small["count"] > 60, small
    left, top, width, height = browser.rect(".force-scale")
    assert left >= 0 and left + width <= 400 and browser.js("return document.scrollingElement.scrollWidth") == 400
    browser.media()
    browser.resize(800, 640)
    browser.js("tcs.seek(0.3)")
    browser.after_pictures()
    left, top, width, height = browser.rect("[data-set=forces]")
    browser.click(left + width / 2, top + height / 2)
    assert browser.after_pictures(ARROWS)["count"] == 0, "they stay"


def small_and_touched(browser):
    browser.resize(400, 800, mobile=True)
    browser.open(f"{FOLDER}/rover.html")
    browser.after_pictures()
    assert browser.js("return [document.scrollingElement.scrollWidth, innerWidth]") == [400, 400]
    assert browser.js("return document.querySelector('.of-forces').hidden"), "nobody has recorded the rover's forces"
    left, top, width, height = browser.rect(".stage")
    before = browser.js("return tcs.view.orbit.turn")
    browser.finger(*[(left + 60 + 20 * i, top + height / 2) for i in range(8)])
    assert browser.js("return tcs.view.orbit.turn") != before, "a finger does not turn the world"
    left, top, width, height = browser.rect("#motion .live svg")
    browser.finger((left + width * 0.6, top + height / 2), (left + width * 0.6, top + height / 2))
    assert 1.5 < now(browser) < 3, now(browser)
    browser.resize(800, 640)


def dark(browser):
    browser.after_pictures()
    light = pixels(browser)
    browser.media(dark=True)
    browser.after_pictures()
    night = pixels(browser)
    assert sum(light[:40]) > sum(night[:40]) + 2000, "the world is as bright in the dark"
    browser.media()


def in_print(browser):
    browser.media("print")
    shown = browser.js("""const is = selector => [...document.querySelectorAll(selector)].some(e => e.getBoundingClientRect().height > 0);
        return {canvas: is('.stage canvas'), player: is('#player'), live: is('.live'), paths: is('#paths > svg.wide'),
                motion: is('#motion > svg.wide'), timeline: is('#timeline > svg.wide'), said: is('#said')};""")
    assert shown == {"canvas": True, "player": False, "live": False, "paths": True, "motion": True, "timeline": True, "said": True}, shown
    browser.media()
    assert len(base64.b64decode(browser.cdp("Page.printToPDF")["data"])) > 20_000


def what_was_said(browser):
    browser.open(f"{FOLDER}/talk.html")
    browser.after_pictures()
    said = browser.js("return tcs.run.said.map(line => [line.time, line.text, line.isMark])")
    assert [text.split("<")[0] for _, text, _ in said] == ["tick ", "half way", "tick ", "tick "], said
    assert [is_mark for _, _, is_mark in said] == [False, True, False, False], said
    # The program said by its own clock when that was; what it does until the line is written takes microseconds.
    clock = [float(said[i][1][6:-1]) - said[i][0] for i in (0, 2, 3)]
    assert max(clock) - min(clock) < 1e-4 and 0.4 <= said[0][0] < 0.8, said
    assert browser.js("return document.querySelectorAll('#player .flags i').length") == 4
    assert browser.js("return document.querySelectorAll('#player .flags i.mark').length") == 1
    assert browser.js("return document.querySelectorAll('#timeline path.said').length") == 4
    assert browser.js("return document.querySelectorAll('#motion path.mark').length") == 1
    browser.js("document.querySelectorAll('#said-lines button')[2].click()")
    assert abs(now(browser) - said[2][0]) < 1e-9
    assert browser.js("return document.querySelector('#said-lines .is-now .text').textContent") == said[2][1]
    drone = bodies("talk", "drone")
    browser.js("tcs.seek(1)")
    is_at(browser, 1, "drone", drone)


def without_webgl():
    with Browser(FOLDER + "/flat", webgl=False) as browser:
        browser.open(f"{FOLDER}/rover.html")
        sentence = browser.js("const p = document.querySelector('.no3d'); return p.hidden ? '' : p.textContent")
        assert "WebGL is missing or switched off" in sentence, sentence
        where = "const dot = document.querySelector('#paths circle.now'); return Number(dot.getAttribute('cx'));"
        before = browser.js("tcs.seek(0);" + where)
        after = browser.js("tcs.seek(3.9);" + where)
        assert after > before + 5, (before, after)


def main():
    import os
    os.mkdir(FOLDER + "/flat")
    with Browser(FOLDER) as browser:
        for check in (the_world, the_picture, slider_and_keys, speed, timeline, rays, lost_picture, forces, small_and_touched, dark, in_print, what_was_said):
            check(browser)
            print(check.__name__, flush=True)
        complaints = browser.complaints()
        assert not complaints, complaints
        assert browser.js("return performance.getEntriesByType('resource').length") == 0, "the page asks others for something"
    without_webgl()


main()
