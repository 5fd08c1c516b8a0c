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

  function decode(element) {
    const run = JSON.parse(element.textContent);
    const numbers = numbersIn(run.times);
    run.time = new Float64Array(run.count);
    for (let i = 0, us = 0; i < run.count; ++i) run.time[i] = (us += numbers.number()) / 1e6;
    run.tracks = run.tracks.map(decodeTrack);
    run.signals = run.signals.map(decodeSignal);
    run.said = run.said.map(([us, client, stream, text, isMark]) => ({time: us / 1e6, client, stream, text, isMark}));
    run.end = Math.max(run.end, run.count ? run.time[run.count - 1] : 0, 1e-6);
    run.scene = run.scene || {region: null, fixtures: [], meshes: [], sensors: [], tracks: []};
    return run;
  }

  const runs = [...document.querySelectorAll('script.replay')].map(decode);
  const state = {runs, run: runs[0] || null, time: 0, robot: 0, isPlaying: false, speed: 1};

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

  // --- The moment ----------------------------------------------------------------------------------

  const listeners = [];
  const tell = what => listeners.forEach(listener => listener(what));

  function seek(time) {
    if (!state.run) return;
    state.time = Math.min(state.run.end, Math.max(0, time));
    tell('time');
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
    seek(state.time + passed);
    if (state.isPlaying) requestAnimationFrame(onFrame);
  }
  function play() {
    if (!state.run || state.isPlaying) return;
    if (state.time >= state.run.end - 1e-9) state.time = 0;
    state.isPlaying = true;
    last = performance.now();
    requestAnimationFrame(onFrame);
    tell('playing');
  }
  function pause() {
    if (!state.isPlaying) return;
    state.isPlaying = false;
    tell('playing');
  }

  return Object.assign(state, {
    numbersIn, momentAt, poseAt, seek, step, play, pause,
    on: listener => listeners.push(listener),
    toggle: () => state.isPlaying ? pause() : play(),
    setSpeed: speed => { state.speed = speed; tell('playing'); },
    chooseRobot: robot => { state.robot = robot; tell('robot'); },
    chooseRun: run => {
      if (!runs[run] || runs[run] === state.run) return;
      state.run = runs[run];
      state.robot = Math.min(state.robot, Math.max(0, state.run.robots.length - 1));
      tell('run');
      seek(state.time);
    },
    // For who asks by name: where it is now.
    pose: name => poseAt(state.run, state.run.tracks.findIndex(track => track.name === name), state.time),
    colourOf: robot => `s${robot % 7}`,
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
