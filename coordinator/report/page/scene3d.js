// The world in three dimensions, by three.js. Where the browser has no WebGL a sentence says so, and
// the views from above and from the side are what there is.
(() => {
  'use strict';
  const replay = document.getElementById('replay');
  if (!replay || !tcs.run) return;
  const stage = replay.querySelector('.stage');
  const canvas = replay.querySelector('canvas');
  const nameLayer = replay.querySelector('.names');
  const options = {follow: false, trails: true, names: true, rays: false, forces: false};
  replay.hidden = false;

  // --- What is chosen, with or without WebGL -------------------------------------------------------

  const set = name => replay.querySelector(`[data-set=${name}]`);
  function fillRobots() {
    set('robot').replaceChildren(...tcs.run.robots.map((robot, i) => new Option(robot.name, i)));
    set('robot').value = tcs.robot;
    set('robot').closest('label').hidden = tcs.run.robots.length < 2;
    replay.querySelector('.of-rays').hidden = tcs.run.scene.sensors.length === 0;
    offerForces();
  }
  // Of a run that goes on, from the first contact on.
  function offerForces() {
    replay.querySelector('.of-forces').hidden = tcs.run.contacts.sizes.length === 0;
  }
  tcs.runs.forEach((run, i) => set('run').add(new Option(run.name, i)));
  replay.querySelector('.of-run').hidden = tcs.runs.length < 2;
  set('run').addEventListener('change', () => tcs.chooseRun(Number(set('run').value)));
  set('robot').addEventListener('change', () => tcs.chooseRobot(Number(set('robot').value)));
  fillRobots();

  let renderer = null;
  try {
    // So that it can be printed.
    renderer = new THREE.WebGLRenderer({canvas, antialias: true, preserveDrawingBuffer: true});
  } catch (error) {
    const sentence = replay.querySelector('.no3d');
    sentence.hidden = false;
    sentence.textContent = 'This browser shows nothing in three dimensions here: WebGL is missing or switched off. ' +
        'The views from above and from the side, below, follow the time all the same.';
    stage.classList.add('is-flat');
    stage.removeAttribute('tabindex');
    ['follow', 'trails', 'names', 'rays', 'forces'].forEach(name => { set(name).closest('label').hidden = true; });
    tcs.on(what => { if (what === 'run') fillRobots(); });
    tcs.view = null;
    return;
  }

  // --- Colours, of the light and of the dark -------------------------------------------------------

  const colours = {};
  function readColours() {
    const style = getComputedStyle(document.documentElement);
    for (const name of ['paper', 'ink', 'faint', 'grid', 'panel', 'force', 's0', 's1', 's2', 's3', 's4', 's5', 's6', 's7']) {
      colours[name] = new THREE.Color(style.getPropertyValue(`--${name}`).trim());
    }
    colours.stage = new THREE.Color(style.getPropertyValue('--stage').trim());
    colours.isDark = colours.paper.r < 0.5;
  }

  // --- The scene -----------------------------------------------------------------------------------

  renderer.setPixelRatio(Math.min(2, window.devicePixelRatio || 1));
  renderer.shadowMap.enabled = true;
  renderer.shadowMap.type = THREE.PCFSoftShadowMap;
  const camera = new THREE.PerspectiveCamera(40, 16 / 9, 0.01, 5000);
  camera.up.set(0, 0, 1);
  const orbit = {target: new THREE.Vector3(), radius: 10, turn: -2.2, height: 0.5};
  let scene = null, groups = [], trails = [], stalks = [], rays = null, arrows = null, bounds = null, names = [], reaches = [];

  const vector = list => new THREE.Vector3(...list);
  const place = (object, pose) => {
    object.position.set(pose[0], pose[1], pose[2]);
    object.quaternion.set(pose[3], pose[4], pose[5], pose[6]);
  };

  // The corners of a box around a shape, in the frame that the shape's pose is in.
  function cornersOf(shape, meshes) {
    if (shape.kind === 'plane') return [];
    const half = [0, 1, 2].map(axis => {
      if (shape.size) return shape.size[axis] / 2;
      if (shape.kind === 'mesh') return Math.max(...meshes[shape.mesh].vertices.map(vertex => Math.abs(vertex[axis])));
      const ends = shape.kind === 'capsule' ? shape.radius : 0;
      return axis === 2 && shape.length ? shape.length / 2 + ends : shape.radius;
    });
    const frame = new THREE.Object3D();
    place(frame, shape.pose);
    frame.updateMatrix();
    return [0, 1, 2, 3, 4, 5, 6, 7].map(i => new THREE.Vector3(...half.map((x, axis) => i >> axis & 1 ? x : -x)).applyMatrix4(frame.matrix));
  }

  // All that there is to be seen, wherever it will be.
  function boxOf(run) {
    const box = new THREE.Box3();
    const {fixtures, meshes, region} = run.scene;
    reaches = run.tracks.map((track, i) =>
        Math.max(0.02, ...(run.scene.tracks[i] || []).flatMap(shape => cornersOf(shape, meshes).map(corner => corner.length()))));
    run.tracks.forEach((track, i) => {
      const reach = reaches[i];
      const stride = Math.max(1, Math.floor(track.count / 200));
      for (let k = 0; k < track.count; k += stride) {
        const at = vector(track.poses.subarray(7 * k, 7 * k + 3));
        box.expandByPoint(at.clone().addScalar(-reach)).expandByPoint(at.addScalar(reach));
      }
    });
    for (const shape of fixtures) cornersOf(shape, meshes).forEach(corner => box.expandByPoint(corner));
    if (region) box.expandByPoint(new THREE.Vector3(region, region, region)).expandByPoint(new THREE.Vector3(-region, -region, -region));
    // Of a run that goes on there is more to come, all around.
    if (tcs.isLive && !box.isEmpty()) box.expandByScalar(Math.max(0.3, 0.05 * box.getSize(new THREE.Vector3()).length()));
    if (box.isEmpty()) box.set(new THREE.Vector3(-1, -1, -1), new THREE.Vector3(1, 1, 1));
    return box;
  }

  function geometryOf(shape, meshes) {
    switch (shape.kind) {
      case 'box':
      case 'body':
        return new THREE.BoxBufferGeometry(...shape.size.map(size => Math.max(size, 1e-4)));
      case 'sphere':
        return new THREE.SphereBufferGeometry(shape.radius, 24, 16);
      case 'cylinder':
        return new THREE.CylinderBufferGeometry(shape.radius, shape.radius, shape.length, 28).rotateX(Math.PI / 2);
      case 'capsule': {
        const profile = [];
        for (let i = 0; i <= 16; ++i) {
          const angle = Math.PI * (i / 16 - 0.5);
          profile.push(new THREE.Vector2(shape.radius * Math.cos(angle),
                                         shape.radius * Math.sin(angle) + (i < 8.5 ? -1 : 1) * shape.length / 2));
        }
        return new THREE.LatheBufferGeometry(profile, 24).rotateX(Math.PI / 2);
      }
      case 'mesh': {
        const mesh = meshes[shape.mesh], geometry = new THREE.BufferGeometry();
        const corners = mesh.triangles.flatMap(triangle => triangle.flatMap(vertex => mesh.vertices[vertex]));
        geometry.setAttribute('position', new THREE.Float32BufferAttribute(corners, 3));
        geometry.computeVertexNormals();
        return geometry;
      }
      default:
        return null;
    }
  }

  function solidOf(shape, colour, meshes) {
    const geometry = geometryOf(shape, meshes);
    if (!geometry) return null;
    const given = shape.colour;
    const material = new THREE.MeshLambertMaterial({color: given ? new THREE.Color(...given.slice(0, 3)) : colour});
    if (given && given[3] < 1) Object.assign(material, {transparent: true, opacity: given[3]});
    const isLooks = shape.kind === 'mesh' && meshes[shape.mesh].isLooks;
    if (isLooks) material.side = THREE.DoubleSide;  // files turn their triangles either way
    const mesh = new THREE.Mesh(geometry, material);
    mesh.castShadow = mesh.receiveShadow = true;
    place(mesh, shape.pose);
    if (shape.kind !== 'sphere' && shape.kind !== 'capsule' && !isLooks) {
      const edges = new THREE.LineSegments(new THREE.EdgesGeometry(geometry, 30),
                                           new THREE.LineBasicMaterial({color: colours.ink, transparent: true, opacity: 0.3}));
      mesh.add(edges);
    }
    return mesh;
  }

  // Where a body without a shape looks: along its x axis.
  function noseOf(size) {
    const nose = new THREE.Mesh(new THREE.ConeBufferGeometry(Math.min(size[1], size[2]) * 0.22, size[0] * 0.45, 16).rotateZ(-Math.PI / 2),
                                new THREE.MeshLambertMaterial({color: colours.ink}));
    nose.position.x = size[0] * 0.72;
    return nose;
  }

  const niceStep = length => {
    const power = Math.pow(10, Math.floor(Math.log10(length / 12)));
    return [1, 2, 5, 10].map(f => f * power).find(step => length / step <= 14);
  };

  function addFloor(run) {
    const plane = run.scene.fixtures.find(shape => shape.kind === 'plane');
    const size = bounds.getSize(new THREE.Vector3()), middle = bounds.getCenter(new THREE.Vector3());
    const isRegion = !plane && run.scene.region;
    const step = niceStep(Math.max(size.x, size.y, size.z * 0.7, 1e-3));
    const reach = isRegion ? run.scene.region : Math.max(size.x, size.y, size.z * 0.7) * 0.5 + step;
    const floor = new THREE.Group();
    const snap = x => isRegion ? 0 : Math.round(x / step) * step;
    const lines = [], extent = isRegion ? reach : Math.ceil(reach / step) * step;
    for (let at = -extent; at <= extent + step / 2; at += isRegion ? 2 * reach / Math.round(2 * reach / step) : step) {
      lines.push(-extent, at, 0, extent, at, 0, at, -extent, 0, at, extent, 0);
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.Float32BufferAttribute(lines, 3));
    const grid = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({color: colours.faint, transparent: true, opacity: 0.28}));
    grid.position.z = size.z * 1e-3 + 1e-4;
    floor.add(grid);
    if (plane) {
      const ground = new THREE.Mesh(new THREE.PlaneBufferGeometry(2 * extent, 2 * extent),
                                    new THREE.MeshLambertMaterial({color: colours.panel}));
      ground.receiveShadow = true;
      floor.add(ground);
      place(floor, plane.pose);
      const up = new THREE.Vector3(0, 0, 1).applyQuaternion(floor.quaternion);
      if (up.z > 0.99) floor.position.set(snap(middle.x), snap(middle.y), plane.pose[2]);
    } else {
      floor.position.set(snap(middle.x), snap(middle.y), isRegion ? -reach : bounds.min.z);
    }
    scene.add(floor);
    if (isRegion) {
      const cube = new THREE.LineSegments(new THREE.EdgesGeometry(new THREE.BoxBufferGeometry(2 * reach, 2 * reach, 2 * reach)),
                                          new THREE.LineBasicMaterial({color: colours.faint, transparent: true, opacity: 0.5}));
      scene.add(cube);
    }
    return plane ? null : floor.position.z;
  }

  function addLight() {
    scene.add(new THREE.HemisphereLight(0xffffff, colours.isDark ? 0x30343a : 0xb8bcc2, colours.isDark ? 0.75 : 0.72));
    const sun = new THREE.DirectionalLight(0xffffff, colours.isDark ? 0.55 : 0.42);
    const size = bounds.getSize(new THREE.Vector3()), middle = bounds.getCenter(new THREE.Vector3());
    const reach = size.length() / 2 + 0.1;
    sun.position.copy(middle).add(new THREE.Vector3(-0.5, -0.8, 1.6).normalize().multiplyScalar(reach * 2));
    sun.target.position.copy(middle);
    sun.castShadow = true;
    sun.shadow.mapSize.set(1024, 1024);
    Object.assign(sun.shadow.camera, {left: -reach, right: reach, top: reach, bottom: -reach, near: reach * 0.2, far: reach * 4});
    sun.shadow.bias = -0.002;
    scene.add(sun, sun.target);
  }

  const lineOf = (count, colour, opacity) => {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(count * 3), 3));
    const line = new THREE.Line(geometry, new THREE.LineBasicMaterial({color: colour, transparent: true, opacity}));
    line.frustumCulled = false;
    return line;
  };

  // The moments that have come since. False if there is no room for them.
  function lengthen(each) {
    const {count, poses} = tcs.run.tracks[each.path];
    if (count + 1 > each.room) return false;
    for (; each.known < count; ++each.known) each.points.set(poses.subarray(7 * each.known, 7 * each.known + 3), 3 * each.known);
    each.trail.geometry.attributes.position.array.set(each.points);
    each.isStale = true;
    return true;
  }
  // Whether all of a run that goes on is still where it is looked for.
  function isInBounds() {
    return tcs.run.tracks.every(({count, poses}, i) => count === 0 || i >= reaches.length ||
        bounds.containsPoint(vector(poses.subarray(7 * count - 7, 7 * count - 4))));
  }

  function build() {
    const {run} = tcs;
    readColours();
    scene = new THREE.Scene();
    scene.background = colours.stage;
    bounds = boxOf(run);
    groups = [];
    trails = [];
    stalks = [];
    nameLayer.replaceChildren();
    addLight();
    const foot = addFloor(run);
    for (const shape of run.scene.fixtures) {
      const solid = solidOf(shape, colours.faint, run.scene.meshes);
      if (!solid) continue;
      // What stands around does not hide what moves in it.
      Object.assign(solid.material, {transparent: true, opacity: 0.22, depthWrite: false});
      solid.castShadow = false;
      scene.add(solid);
    }
    const robotOf = new Map();
    run.robots.forEach((robot, i) => {
      robotOf.set(robot.root, i);
      robot.paths.forEach(path => robotOf.set(path, i));
    });
    let robotBefore = 0;
    run.tracks.forEach((track, i) => {
      robotBefore = robotOf.has(i) ? robotOf.get(i) : robotBefore;
      const group = new THREE.Group(), colour = colours[tcs.colourOf(robotBefore)];
      const shapes = run.scene.tracks[i] || [{kind: 'sphere', radius: 0.02 * bounds.getSize(new THREE.Vector3()).length(), pose: [0, 0, 0, 0, 0, 0, 1]}];
      for (const shape of shapes) {
        const solid = solidOf(shape, colour, run.scene.meshes);
        if (!solid) continue;
        if (shape.kind === 'body') solid.add(noseOf(shape.size));
        group.add(solid);
      }
      group.userData.robot = robotBefore;
      scene.add(group);
      groups.push(group);
    });
    names = run.robots.map((robot, i) => {
      const label = document.createElement('span');
      label.className = tcs.colourOf(i);
      label.textContent = robot.name;
      nameLayer.append(label);
      for (const path of robot.paths) {
        const track = run.tracks[path];
        if (track.count > 1 || tcs.isLive) {
          const room = tcs.isLive ? Math.max(2000, 2 * track.count) : track.count + 1;
          const trail = lineOf(room, colours[tcs.colourOf(i)], 0.9);
          scene.add(trail);
          trails.push({trail, path, room, points: new Float32Array(3 * room), known: 0, end: 0});
          lengthen(trails[trails.length - 1]);
        }
        if (foot !== null) {
          const stalk = lineOf(2, colours.faint, 0.6);
          scene.add(stalk);
          stalks.push({stalk, path, foot});
        }
      }
      return label;
    });
    rays = null;
    makeArrows(run);
    draw();
  }

  // --- What moves ----------------------------------------------------------------------------------

  // Up to where it is: that point stands in the place of the moment that comes next.
  function showTrail(each) {
    const {trail, path, points, end} = each;
    trail.visible = options.trails;
    if (!options.trails) return;
    const {run, time} = tcs, attribute = trail.geometry.attributes.position;
    const next = tcs.momentAt(run, time) + 1;
    attribute.array.set(points.subarray(3 * end, 3 * end + 3), 3 * end);
    attribute.array.set(tcs.poseAt(run, path, time).slice(0, 3), 3 * next);
    attribute.updateRange = each.isStale ? {offset: 0, count: -1}
        : {offset: 3 * Math.min(end, next), count: 3 * (Math.abs(end - next) + 1)};
    each.isStale = false;
    attribute.needsUpdate = true;
    trail.geometry.setDrawRange(0, next + 1);
    each.end = next;
  }

  // How far each ray of a lidar goes: from the shapes that are drawn, so without the sensor's noise.
  function showRays() {
    if (rays) scene.remove(rays);
    rays = null;
    if (!options.rays) return;
    const points = [], caster = new THREE.Raycaster();
    const solids = [];
    scene.updateMatrixWorld();
    scene.traverse(object => { if (object.isMesh) solids.push(object); });
    for (const sensor of tcs.run.scene.sensors) {
      const group = groups[sensor.track];
      const own = new Set();
      group.traverse(object => own.add(object));
      const others = solids.filter(object => !own.has(object));
      const frame = new THREE.Object3D();
      place(frame, sensor.pose);
      frame.updateMatrix();
      const matrix = group.matrixWorld.clone().multiply(frame.matrix);
      const from = new THREE.Vector3().setFromMatrixPosition(matrix);
      const whole = sensor.last_rad - sensor.first_rad >= 2 * Math.PI - 1e-6;
      for (let i = 0; i < sensor.rays; ++i) {
        const angle = sensor.first_rad + (sensor.last_rad - sensor.first_rad) * i / Math.max(1, sensor.rays - (whole ? 0 : 1));
        const towards = new THREE.Vector3(Math.cos(angle), Math.sin(angle), 0).transformDirection(matrix);
        caster.set(from, towards);
        caster.near = sensor.least_m;
        caster.far = sensor.most_m;
        const hit = caster.intersectObjects(others)[0];
        const to = hit ? hit.point : from.clone().addScaledVector(towards, sensor.most_m);
        points.push(from.x, from.y, from.z, to.x, to.y, to.z);
      }
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.Float32BufferAttribute(points, 3));
    rays = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({color: colours.s0, transparent: true, opacity: 0.35}));
    scene.add(rays);
  }

  // --- Contact forces --------------------------------------------------------------------------------

  // The strength that nine of ten contacts stay below, rounded up, is an arrow about as long as a
  // robot, and seen from afar, too; blows are cut.
  const MOST = 2.5;
  function scaleArrows(run) {
    const {sizes} = run.contacts, stride = Math.ceil(sizes.length / 5000);
    const some = sizes.filter((size, i) => i % stride === 0).sort((a, b) => a - b);
    const usual = some.length ? Math.max(1e-6, some[Math.floor(0.9 * (some.length - 1))]) : 1;
    const power = Math.pow(10, Math.floor(Math.log10(usual)));
    const round = [1, 2, 5, 10].map(f => f * power).find(size => size >= usual * (1 - 1e-9));
    const length = Math.max(0.9 * Math.max(...reaches, 0.02), 0.05 * bounds.getSize(new THREE.Vector3()).length());
    const isCut = sizes.some(size => size > MOST * round);
    Object.assign(arrows, {perNewton: length / round, length, most: MOST * round, isCut});
  }
  function makeArrows(run) {
    const geometry = new THREE.BufferGeometry();
    // What they are in shall not hide them.
    const material = new THREE.MeshBasicMaterial({color: colours.force, transparent: true, opacity: 0.9, depthTest: false, side: THREE.DoubleSide});
    const mesh = new THREE.Mesh(geometry, material);
    mesh.frustumCulled = false;
    mesh.renderOrder = 1;
    arrows = {mesh, room: 0};
    scaleArrows(run);
    scene.add(mesh);
  }

  const RIM = [0, 1, 2, 3, 4, 5, 6].map(i => [Math.cos(i * Math.PI / 3), Math.sin(i * Math.PI / 3)]);
  const NUMBERS = 6 * 4 * 9;  // of an arrow: for each side two triangles of the shaft and two of the head
  function putArrow(array, at, from, force, pixel) {
    const size = force.length();
    if (!(size > 0)) return at;
    const towards = force.clone().divideScalar(size), long = Math.min(size, arrows.most) * arrows.perNewton;
    const aside = new THREE.Vector3(Math.abs(towards.x) < 0.7 ? 1 : 0, Math.abs(towards.x) < 0.7 ? 0 : 1, 0).cross(towards).normalize();
    const other = towards.clone().cross(aside);
    // A short one is small as a whole, and the thinnest can be seen.
    const wide = Math.min(arrows.length, 2 * long), head = 0.26 * wide, neck = long - head;
    const put = (along, radius, [c, s]) => {
      for (const axis of ['x', 'y', 'z']) array[at++] = from[axis] + along * towards[axis] + radius * (c * aside[axis] + s * other[axis]);
    };
    for (let i = 0; i < 6; ++i) {
      const thin = Math.max(0.022 * wide, 0.7 * pixel), thick = Math.max(0.085 * wide, 2.2 * pixel), [a, b] = [RIM[i], RIM[i + 1]];
      put(0, thin, a); put(0, thin, b); put(neck, thin, a);
      put(neck, thin, a); put(0, thin, b); put(neck, thin, b);
      put(neck, thick, a); put(neck, thick, b); put(long, 0, a);
      put(neck, 0, a); put(neck, thick, b); put(neck, thick, a);
    }
    return at;
  }

  function showForces() {
    const scale = replay.querySelector('.force-scale');
    arrows.mesh.visible = options.forces;
    scale.hidden = !options.forces;
    if (!options.forces) return;
    const found = tcs.contactsAt(tcs.run, tcs.time), {geometry} = arrows.mesh;
    if (2 * found.length > arrows.room || !arrows.room) {
      arrows.room = Math.max(64, 4 * found.length);
      geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(NUMBERS * arrows.room), 3));
    }
    const {position} = geometry.attributes, pixel = 1 / pixelsPerMetre();
    let at = 0;
    for (const {point, force, secondMoves} of found) {
      at = putArrow(position.array, at, vector(point), vector(force), pixel);
      if (secondMoves) at = putArrow(position.array, at, vector(point), vector(force).negate(), pixel);
    }
    geometry.setDrawRange(0, at / 3);
    position.needsUpdate = true;
    showScale(scale);
  }
  // Where the camera looks.
  const pixelsPerMetre = () => stage.clientHeight / (2 * orbit.radius * Math.tan(camera.fov * Math.PI / 360));
  // A round number of newtons, as long as it is where the camera looks.
  function showScale(scale) {
    const pixels = pixelsPerMetre() * arrows.perNewton;
    const power = Math.pow(10, Math.floor(Math.log10(90 / pixels)));
    const newtons = [5, 2, 1].map(f => f * power).find(n => n * pixels <= 90);
    const text = n => `${Number(n.toPrecision(2)).toLocaleString('en', {maximumFractionDigits: 9})}\u00a0N`;
    scale.querySelector('i').style.width = `${(newtons * pixels).toFixed(1)}px`;
    scale.querySelector('span').textContent = text(newtons) + (arrows.isCut ? `, cut at ${text(arrows.most)}` : '') +
        (tcs.run.contacts.sums ? ', summed' : '');
  }

  function showNames() {
    const {clientWidth: width, clientHeight: height} = stage;
    const many = names.length > 8;
    names.forEach((label, i) => {
      const robot = tcs.run.robots[i];
      const at = project(robot.paths[0], reaches[robot.paths[0]]);
      const isShown = options.names && at.isAhead && (!many || i === tcs.robot);
      label.hidden = !isShown;
      label.classList.toggle('is-chosen', i === tcs.robot && names.length > 1);
      if (isShown) {
        const x = Math.min(width - 8, Math.max(8, at.x)), y = Math.min(height - 8, Math.max(24, at.y - 4));
        label.style.transform = `translate(${x.toFixed(1)}px,${y.toFixed(1)}px) translate(-50%,-100%)`;
      }
    });
  }

  // Where a track's frame is on the stage, or what is so far above it, in pixels.
  function project(track, above = 0) {
    const [x, y, z] = tcs.poseAt(tcs.run, track, tcs.time);
    const at = new THREE.Vector3(x, y, z + above).project(camera);
    return {x: (at.x + 1) / 2 * stage.clientWidth, y: (1 - at.y) / 2 * stage.clientHeight, isAhead: at.z < 1};
  }

  function aim() {
    if (options.follow && tcs.run.robots[tcs.robot]) {
      orbit.target.copy(vector(tcs.poseAt(tcs.run, tcs.run.robots[tcs.robot].paths[0], tcs.time).slice(0, 3)));
    }
    const {target, radius, turn, height} = orbit;
    camera.position.set(target.x + radius * Math.cos(height) * Math.cos(turn),
                        target.y + radius * Math.cos(height) * Math.sin(turn),
                        target.z + radius * Math.sin(height));
    camera.near = radius / 200;
    camera.far = radius * 50;
    camera.updateProjectionMatrix();
    camera.lookAt(target);
    camera.updateMatrixWorld();
  }

  let width = 0, height = 0, pictures = 0, pending = 0;
  function draw() {
    if (stage.clientWidth !== width || stage.clientHeight !== height) {
      ({clientWidth: width, clientHeight: height} = stage);
      renderer.setSize(width, height, false);
      camera.aspect = width / Math.max(1, height);
    }
    groups.forEach((group, i) => place(group, tcs.poseAt(tcs.run, i, tcs.time)));
    trails.forEach(showTrail);
    for (const {stalk, path, foot} of stalks) {
      const [x, y, z] = tcs.poseAt(tcs.run, path, tcs.time);
      stalk.geometry.attributes.position.array.set([x, y, z, x, y, foot]);
      stalk.geometry.attributes.position.needsUpdate = true;
    }
    showRays();
    aim();
    showForces();
    renderer.render(scene, camera);
    showNames();
    if (++pictures === 1) document.documentElement.dataset.firstPicture = Math.round(performance.now());
  }
  // Once for all that changes between two pictures.
  function drawSoon() {
    if (!pending) pending = requestAnimationFrame(() => { pending = 0; draw(); });
  }

  // --- Looking -------------------------------------------------------------------------------------

  // As near as all of it is seen.
  const fitted = new THREE.Box3();
  function fit() {
    const {min, max} = bounds;
    fitted.copy(bounds);
    const tall = Math.tan(camera.fov * Math.PI / 360) * 0.94;
    const wide = tall * stage.clientWidth / Math.max(1, stage.clientHeight);
    camera.position.set(Math.cos(orbit.height) * Math.cos(orbit.turn), Math.cos(orbit.height) * Math.sin(orbit.turn),
                        Math.sin(orbit.height)).add(orbit.target);
    camera.lookAt(orbit.target);
    camera.updateMatrixWorld();
    const towards = new THREE.Matrix3().setFromMatrix4(camera.matrixWorldInverse.getInverse(camera.matrixWorld));
    orbit.radius = 0.1;
    for (let i = 0; i < 8; ++i) {
      const corner = new THREE.Vector3(i & 1 ? max.x : min.x, i & 2 ? max.y : min.y, i & 4 ? max.z : min.z)
          .sub(orbit.target).applyMatrix3(towards);
      orbit.radius = Math.max(orbit.radius, corner.z + Math.abs(corner.x) / wide, corner.z + Math.abs(corner.y) / tall);
    }
  }

  function lookAt(kind) {
    orbit.target.copy(bounds.getCenter(new THREE.Vector3()));
    Object.assign(orbit, {free: {turn: -2.0, height: 0.55}, top: {turn: -Math.PI / 2, height: Math.PI / 2 - 1e-4},
                          side: {turn: -Math.PI / 2, height: 0}}[kind]);
    fit();
    replay.querySelectorAll('[data-look]').forEach(button => button.setAttribute('aria-pressed', button.dataset.look === kind));
    drawSoon();
  }
  let isAimed = false;  // by hand
  function turn(by, up) {
    isAimed = true;
    orbit.turn -= by;
    orbit.height = Math.min(Math.PI / 2 - 1e-4, Math.max(-1.2, orbit.height + up));
    replay.querySelectorAll('[data-look]').forEach(button => button.setAttribute('aria-pressed', 'false'));
    drawSoon();
  }
  function zoom(factor) {
    isAimed = true;
    orbit.radius = Math.min(1e4, Math.max(0.05, orbit.radius * factor));
    drawSoon();
  }
  function pan(dx, dy) {
    isAimed = true;
    const scale = 2 * orbit.radius * Math.tan(camera.fov * Math.PI / 360) / stage.clientHeight;
    const right = new THREE.Vector3().setFromMatrixColumn(camera.matrixWorld, 0);
    const up = new THREE.Vector3().setFromMatrixColumn(camera.matrixWorld, 1);
    orbit.target.addScaledVector(right, -dx * scale).addScaledVector(up, dy * scale);
    drawSoon();
  }

  const fingers = new Map();
  let pressed = null;
  canvas.addEventListener('pointerdown', event => {
    fingers.set(event.pointerId, event);
    canvas.setPointerCapture(event.pointerId);
    pressed = fingers.size === 1 ? event : null;
    stage.focus({preventScroll: true});
  });
  canvas.addEventListener('pointermove', event => {
    const before = fingers.get(event.pointerId);
    if (!before) return;
    const dx = event.clientX - before.clientX, dy = event.clientY - before.clientY;
    const distance = () => {
      const [a, b] = [...fingers.values()];
      return Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY);
    };
    if (fingers.size === 2) {
      const apart = distance();
      fingers.set(event.pointerId, event);
      zoom(Math.min(2, Math.max(0.5, apart / Math.max(1, distance()))));
      pan(dx / 2, dy / 2);
    } else {
      fingers.set(event.pointerId, event);
      if (event.buttons & 2 || event.shiftKey) pan(dx, dy);
      else turn(dx * 0.008, dy * 0.008);
    }
  });
  for (const over of ['pointerup', 'pointercancel']) {
    canvas.addEventListener(over, event => {
      fingers.delete(event.pointerId);
      const isClick = over === 'pointerup' && pressed && Math.hypot(event.clientX - pressed.clientX, event.clientY - pressed.clientY) < 4;
      pressed = null;
      if (isClick) choose(event);
    });
  }
  function choose(event) {
    const rect = canvas.getBoundingClientRect(), caster = new THREE.Raycaster();
    caster.setFromCamera(new THREE.Vector2((event.clientX - rect.left) / rect.width * 2 - 1,
                                           1 - (event.clientY - rect.top) / rect.height * 2), camera);
    const hit = caster.intersectObjects(groups, true).find(each => each.object.isMesh);
    for (let object = hit && hit.object; object; object = object.parent) {
      if (object.userData.robot !== undefined) return tcs.chooseRobot(object.userData.robot);
    }
  }
  canvas.addEventListener('contextmenu', event => event.preventDefault());
  // The wheel alone scrolls the page, unless the stage was clicked.
  canvas.addEventListener('wheel', event => {
    if (!event.ctrlKey && document.activeElement !== stage) return;
    event.preventDefault();
    zoom(Math.pow(1.0015, event.deltaY));
  }, {passive: false});
  const keys = {
    ArrowLeft: () => turn(-0.12, 0), ArrowRight: () => turn(0.12, 0), ArrowUp: () => turn(0, 0.1), ArrowDown: () => turn(0, -0.1),
    '+': () => zoom(0.85), '=': () => zoom(0.85), '-': () => zoom(1 / 0.85),
    1: () => lookAt('free'), 2: () => lookAt('top'), 3: () => lookAt('side'),
  };
  stage.addEventListener('keydown', event => {
    if (!keys[event.key] || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    keys[event.key]();
  });
  replay.querySelectorAll('[data-look]').forEach(button => button.addEventListener('click', () => {
    options.follow = set('follow').checked = false;
    lookAt(button.dataset.look);
  }));
  for (const name of ['follow', 'trails', 'names', 'rays', 'forces']) {
    set(name).addEventListener('change', () => {
      options[name] = set(name).checked;
      if (name === 'follow' && options.follow) orbit.radius = Math.min(orbit.radius, bounds.getSize(new THREE.Vector3()).length() * 0.35);
      drawSoon();
    });
  }

  tcs.on(what => {
    if (what === 'run') {
      fillRobots();
      build();
      if (!tcs.isLive) lookAt('free');
    }
    if (what === 'grown') {
      offerForces();
      scaleArrows(tcs.run);
    }
    if (what === 'grown' && !(isInBounds() && trails.every(lengthen))) build();
    if ((what === 'grown' || (what === 'run' && tcs.isLive)) && !isAimed && !options.follow && !bounds.equals(fitted)) {
      orbit.target.copy(bounds.getCenter(new THREE.Vector3()));
      fit();
    }
    if (what === 'robot') set('robot').value = tcs.robot;
    drawSoon();
  });
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', build);
  new ResizeObserver(drawSoon).observe(stage);
  // A graphics process that dies, or is ended for standing still, takes the picture with it.
  canvas.addEventListener('webglcontextrestored', drawSoon);
  build();
  lookAt('free');
  // What others may ask, and tests do.
  tcs.view = {project, options, orbit, draw};
})();
