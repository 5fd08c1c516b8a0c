// What the world did, and the moment of it that all of the page shows. Other parts ask `tcs`, and
// are told of each change of the moment, of the run and of the robot that is looked at.
const tcs = (() => {
  'use strict';

  // --- The data: see encode_replay.cc. -------------------------------------------------------------

  // See bytes.h.
  function numbersIn(text) {
    const bytes = Uint8Array.from(atob(text), c => c.charCodeAt(0));
    let at = 0;
    const number = () => {
      let value = 0, scale = 1;
      for (;;) {
        const byte = bytes[at++];
        value += (byte & 127) * scale;
        if (byte < 128) return value;
        scale *= 128;
      }
    };
    const signed = () => {
      const value = number();
      return value % 2 ? -(value + 1) / 2 : value / 2;
    };
    return {number, signed, isAtEnd: () => at >= bytes.length};
  }

  function decodeTrack(track) {
    const numbers = numbersIn(track.data);
    const poses = new Float32Array(track.count * 7);
    const sums = [0, 0, 0, 0, 0, 0, 0];
    for (let i = 0; i < poses.length; ++i) {
      const axis = i % 7;
      sums[axis] += numbers.signed();
      poses[i] = track.least[axis] + sums[axis] * track.step[axis];
    }
    return {name: track.name, count: track.count, poses};
  }

  function decodeSignal(signal) {
    const numbers = numbersIn(signal.data), values = [];
    for (let sum = 0; !numbers.isAtEnd();) {
      sum += numbers.signed();
      values.push(signal.least + sum * signal.step);
    }
    return {...signal, data: null, values};
  }

  // Of a mesh that is only looks; hulls are as they are. See looks.cc.
  function decodeMesh(mesh) {
    if (typeof mesh.vertices !== 'string') return mesh;
    const corners = numbersIn(mesh.vertices), indices = numbersIn(mesh.triangles), vertices = [], triangles = [];
    for (const sums = [0, 0, 0]; !corners.isAtEnd();) {
      vertices.push([0, 1, 2].map(axis => mesh.least[axis] + (sums[axis] += corners.signed()) * mesh.step[axis]));
    }
    for (let last = 0; !indices.isAtEnd();) triangles.push([0, 1, 2].map(() => last += indices.signed()));
    return {vertices, triangles, isLooks: true};
  }

  // Of each moment the contacts that are shown there, [pair, x, y, z, force along x, y, z] after each
  // other, and how strong they all are. See contact_track.cc.
  function decodeContacts(contacts, moments) {
    if (!contacts) return {pairs: [], stride: 1, sums: false, of: [], sizes: []};
    const {least, step} = contacts, numbers = numbersIn(contacts.data), before = contacts.pairs.map(() => []);
    const of = [], sizes = [];
    for (let moment = 0; moment < moments; ++moment) {
      const count = numbers.number(), found = new Float32Array(7 * count), seen = new Map();
      for (let at = 0; at < found.length; at += 7) {
        const pair = numbers.number(), number = seen.get(pair) || 0;
        seen.set(pair, number + 1);
        const sums = before[pair][number] = before[pair][number] || [0, 0, 0, 0, 0, 0];
        found[at] = pair;
        for (let i = 0; i < 6; ++i) found[at + 1 + i] = least[i] + (sums[i] += numbers.signed()) * step[i];
        sizes.push(Math.hypot(found[at + 4], found[at + 5], found[at + 6]));
      }
      of.push(found);
    }
    const pairs = contacts.pairs.map(([first, second, secondMoves]) => ({first, second, secondMoves}));
    return {pairs, stride: contacts.stride, sums: contacts.sums, of, sizes};
  }

  function decode(run) {
    const numbers = numbersIn(run.times);
    run.time = new Float64Array(run.count);
    for (let i = 0, us = 0; i < run.count; ++i) run.time[i] = (us += numbers.number()) / 1e6;
    run.tracks = run.tracks.map(decodeTrack);
    run.signals = run.signals.map(decodeSignal);
    run.contacts = decodeContacts(run.contacts, run.count);
    run.said = run.said.map(([us, client, stream, text, isMark]) => ({time: us / 1e6, client, stream, text, isMark}));
    run.end = Math.max(run.end, run.count ? run.time[run.count - 1] : 0, 1e-6);
    run.scene = run.scene || {region: null, fixtures: [], meshes: [], sensors: [], tracks: []};
    run.scene.meshes = run.scene.meshes.map(decodeMesh);
    return run;
  }

  const runs = [...document.querySelectorAll('script.replay')].map(element => decode(JSON.parse(element.textContent)));
  const state = {runs, run: runs[0] || null, time: 0, robot: 0, isPlaying: false, isFollowing: false, speed: 1,
                 isLive: document.querySelector('script.live') !== null};

  // --- Where things are ----------------------------------------------------------------------------

  // The last moment at or before the time.
  function momentAt(run, time) {
    let low = 0, high = run.count - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (run.time[middle] <= time + 1e-9) low = middle; else high = middle - 1;
    }
    return low;
  }

  // Between two moments on the straight line, and turned in proportion.
  function poseAt(run, track, time) {
    const {count, poses} = run.tracks[track];
    const pose = new Array(7);
    if (count < 2) {
      for (let i = 0; i < 7; ++i) pose[i] = count ? poses[i] : i === 6 ? 1 : 0;
      return pose;
    }
    const before = momentAt(run, time), after = Math.min(before + 1, count - 1);
    const length = run.time[after] - run.time[before];
    const share = length > 0 ? Math.min(1, Math.max(0, (time - run.time[before]) / length)) : 0;
    let size = 0;
    for (let i = 0; i < 7; ++i) {
      pose[i] = poses[before * 7 + i] * (1 - share) + poses[after * 7 + i] * share;
      if (i > 2) size += pose[i] * pose[i];
    }
    size = Math.sqrt(size) || 1;
    for (let i = 3; i < 7; ++i) pose[i] /= size;
    return pose;
  }

  // What touches what: where, and what the first one feels. Of the last moment that has any, not
  // between two: contacts come and go.
  function contactsAt(run, time) {
    const {pairs, stride, of} = run.contacts, moment = momentAt(run, time);
    const found = of[moment - moment % stride] || [], list = [];
    for (let at = 0; at < found.length; at += 7) {
      list.push({...pairs[found[at]], point: [...found.subarray(at + 1, at + 4)], force: [...found.subarray(at + 4, at + 7)]});
    }
    return list;
  }

  // --- The moment ----------------------------------------------------------------------------------

  const listeners = [];
  const tell = what => listeners.forEach(listener => listener(what));

  function show(time) {
    if (!state.run) return;
    state.time = Math.min(state.run.end, Math.max(0, time));
    tell('time');
  }
  function seek(time) {
    leave();
    show(time);
  }
  // By moments of the replay.
  function step(count) {
    const {run} = state;
    if (!run || !run.count) return;
    pause();
    const here = momentAt(run, state.time);
    const isBetween = state.time > run.time[here] + 1e-9;
    const next = count < 0 && isBetween ? here : here + count;
    seek(run.time[Math.min(run.count - 1, Math.max(0, next))]);
  }

  let last = 0;
  function onFrame(now) {
    if (!state.isPlaying) return;
    const passed = Math.min(0.25, (now - last) / 1000) * state.speed;
    last = now;
    if (state.time + passed >= state.run.end) pause();
    show(state.time + passed);
    if (state.isPlaying) requestAnimationFrame(onFrame);
  }
  function play() {
    if (!state.run || state.isPlaying) return;
    leave();
    if (state.time >= state.run.end - 1e-9) state.time = 0;
    state.isPlaying = true;
    last = performance.now();
    requestAnimationFrame(onFrame);
    tell('playing');
  }
  function pause() {
    leave();
    if (!state.isPlaying) return;
    state.isPlaying = false;
    tell('playing');
  }

  // --- A run that goes on ----------------------------------------------------------------------------

  const joined = (a, b) => {
    const all = new a.constructor(a.length + b.length);
    all.set(a);
    all.set(b, a.length);
    return all;
  };
  // All moments of a track, also of one that stands still.
  function spread({name, count, poses}, moments) {
    if (count === moments || count === 0) return {name, count, poses};
    const all = new Float32Array(moments * 7);
    for (let i = 0; i < moments; ++i) all.set(poses.subarray(7 * Math.min(i, count - 1), 7 * Math.min(i, count - 1) + 7), 7 * i);
    return {name, count: moments, poses: all};
  }
  function append(run, part) {
    run.tracks = run.tracks.map((track, i) => {
      const own = spread(track, run.count), more = spread(part.tracks[i], part.count);
      return {name: own.name, count: own.count + more.count, poses: joined(own.poses, more.poses)};
    });
    for (const signal of part.signals) {
      const known = run.signals.find(own => own.robot === signal.robot && own.panel === signal.panel && own.name === signal.name);
      if (known) known.values.push(...signal.values);
      else run.signals.push({...signal, first: signal.first + run.count});
    }
    const {contacts} = run, missing = run.count - contacts.of.length;
    for (let i = 0; i < missing; ++i) contacts.of.push(new Float32Array(0));
    run.contacts = {...contacts, stride: part.contacts.stride, sums: part.contacts.sums,
                    pairs: part.contacts.pairs.length ? part.contacts.pairs : contacts.pairs,
                    of: contacts.of.concat(part.contacts.of), sizes: contacts.sizes.concat(part.contacts.sizes)};
    run.time = joined(run.time, part.time);
    run.count += part.count;
    run.said.push(...part.said);
  }

  // What the server says is new, from which moment on. From the first on it takes the place of all.
  function grow(news, from) {
    const part = decode(news), {run} = state;
    const isWhole = from.moments === 0;
    const last = run.count ? run.time[run.count - 1] : 0;
    if (isWhole) {
      Object.assign(run, part);
      run.tracks = run.tracks.map(track => spread(track, run.count));
    } else {
      append(run, part);
      if (part.count) run.end = run.time[run.count - 1];
    }
    const isOther = JSON.stringify(run.robots) !== JSON.stringify(part.robots);
    run.robots = part.robots;
    if (state.time > run.end) state.time = run.end;
    tell(isWhole || isOther ? 'run' : 'grown');
    if (state.isFollowing) glide(part.count && run.end - last);
  }

  // To the newest moment, in about the time until the next one comes: so that it moves evenly. Where pictures take long, as
  // without a graphics processor, once for each newest moment: the run needs the processor, too.
  const LONG = 40, MANY = 6;  // milliseconds from picture to picture; so many of them
  let path = null, arrived = 0, gliding = 0, drawn = 0, slow = 0;
  function glide(more) {
    const now = performance.now();
    if (more || !path) {
      slow = Math.max(0, slow - 0.5);  // now and then it is tried again
      path = {from: state.time, to: state.run.end, begin: now, length: Math.min(600, Math.max(60, 1.1 * (now - arrived)))};
      arrived = now;
      if (!gliding) gliding = requestAnimationFrame(onGlide);
    }
  }
  function onGlide(now) {
    gliding = 0;
    if (!state.isFollowing || !path) return;
    if (drawn) slow = now - drawn > LONG ? slow + 1 : Math.max(0, slow - 1);
    const share = slow > MANY ? 1 : Math.min(1, Math.max(0, (now - path.begin) / path.length));
    drawn = share < 1 ? now : 0;
    show(path.from + (path.to - path.from) * share);
    if (share < 1 && !gliding) gliding = requestAnimationFrame(onGlide);
  }
  function follow() {
    pause();
    state.isFollowing = true;
    path = null;
    tell('following');
    show(state.run.end);
  }
  function leave() {
    if (!state.isFollowing) return;
    state.isFollowing = false;
    tell('following');
  }

  return Object.assign(state, {
    grow, follow,
    numbersIn, momentAt, poseAt, contactsAt, seek, step, play, pause,
    on: listener => listeners.push(listener),
    toggle: () => state.isPlaying ? pause() : play(),
    setSpeed: speed => { state.speed = speed; tell('playing'); },
    chooseRobot: robot => { state.robot = robot; tell('robot'); },
    chooseRun: run => {
      if (!runs[run] || runs[run] === state.run) return;
      state.run = runs[run];
      state.robot = Math.min(state.robot, Math.max(0, state.run.robots.length - 1));
      tell('run');
      show(state.time);
    },
    // For who asks by name: where it is now.
    pose: name => poseAt(state.run, state.run.tracks.findIndex(track => track.name === name), state.time),
    COLOURS: 8,
    colourOf: robot => `s${robot % 8}`,
    // Draws when the element has another width: outside of the observer, for drawing changes heights.
    onWidth: (element, draw) => {
      let width = element.clientWidth;
      new ResizeObserver(() => {
        if (element.clientWidth === width) return;
        width = element.clientWidth;
        requestAnimationFrame(draw);
      }).observe(element);
    },
  });
})();
