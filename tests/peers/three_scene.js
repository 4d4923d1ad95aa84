// The views in three.js, from a map without the sun's disc and the JSON of its light.

import * as THREE from 'three';
import { EXRLoader } from 'three/addons/loaders/EXRLoader.js';

export async function renderViews(settings) {
  const renderer = new THREE.WebGLRenderer({ antialias: false });
  renderer.shadowMap.enabled = true;
  renderer.shadowMap.type = THREE.PCFShadowMap;
  const map = await new EXRLoader().setDataType(THREE.FloatType).loadAsync('/map.exr');
  map.mapping = THREE.EquirectangularReflectionMapping;
  const given = { ...settings, renderer, map };
  const [plane, ball, pole] = ['plane', 'ball', 'pole'].map((name) => settings.views[name]);
  const views = {
    plane: view(given, aPlane(given), above(plane[0]), plane[1], plane[1]),
    sphere: view(given, aBall(given, [0, 0, 0], false), north(ball[0]), ball[1], ball[1]),
    mirror: view(given, aBall(given, [0, 0, 0], true), north(ball[0]), ball[1], ball[1]),
    pole: view(given, withPole(given), above(pole[0]), pole[1], pole[1]),
    picture: view(given, everything(given), perspective(settings), ...settings.picture),
  };
  return { version: THREE.REVISION, views };
}

function lit({ map, sun }, objects) {
  const scene = new THREE.Scene();
  scene.environment = map;
  scene.background = map;
  const light = new THREE.DirectionalLight();
  light.color.setRGB(...sun.irradiance, THREE.LinearSRGBColorSpace);
  light.position.set(...sun.target_direction).multiplyScalar(20);
  light.castShadow = true;
  light.shadow.mapSize.set(4096, 4096);
  Object.assign(light.shadow.camera, { left: -4, right: 4, top: 4, bottom: -4, far: 40 });
  light.shadow.bias = -0.0005;
  scene.add(light, light.target, ...objects);
  return scene;
}

function material({ albedo }, isMirror) {
  const color = new THREE.Color().setScalar(isMirror ? 1 : albedo);
  return new THREE.MeshStandardMaterial({
    color,
    metalness: isMirror ? 1 : 0,
    roughness: isMirror ? 0 : 1,
  });
}

function mesh(given, geometry, isMirror, place) {
  const made = new THREE.Mesh(geometry, material(given, isMirror));
  made.position.set(...place);
  made.castShadow = true;
  made.receiveShadow = true;
  return made;
}

function aPlane(given) {
  const made = mesh(given, new THREE.PlaneGeometry(100, 100), false, [0, 0, 0]);
  made.rotation.x = -Math.PI / 2;
  return [made];
}

function aBall(given, place, isMirror) {
  const made = mesh(given, new THREE.SphereGeometry(1, 256, 128), isMirror, place);
  // A sphere that is lit alone has no shadow but its own dark side.
  made.castShadow = place[1] > 0;
  made.receiveShadow = false;
  return [made];
}

function aPole(given, x, z, height, radius) {
  const shape = new THREE.CylinderGeometry(radius, radius, height, 48);
  return mesh(given, shape, false, [x, height / 2, z]);
}

function withPole(given) {
  return [...aPlane(given), aPole(given, 0, 0, ...given.pole)];
}

function everything(given) {
  return [
    ...aPlane(given),
    ...aBall(given, [-1.1, 1, 0], false),
    ...aBall(given, [1.1, 1, 0], true),
    aPole(given, 0, 1.6, 1.2, 0.06),
  ];
}

function above(half) {
  const camera = new THREE.OrthographicCamera(-half, half, half, -half, 0.1, 20);
  camera.position.set(0, 10, 0);
  camera.up.set(0, 0, -1);
  camera.lookAt(0, 0, 0);
  return camera;
}

function north(half) {
  const camera = new THREE.OrthographicCamera(-half, half, half, -half, 0.1, 20);
  camera.position.set(0, 0, 10);
  camera.lookAt(0, 0, 0);
  return camera;
}

function perspective({ picture: [width, height] }) {
  const across = Math.tan((20 * Math.PI) / 180);
  const fov = (2 * Math.atan((across * height) / width) * 180) / Math.PI;
  const camera = new THREE.PerspectiveCamera(fov, width / height, 0.1, 100);
  camera.position.set(0, 2.2, 8);
  camera.lookAt(0, 0.8, 0);
  return camera;
}

// Linear pixels, row 0 at the top, as they are before a tone mapping.
function view(given, objects, camera, width, height) {
  const { renderer } = given;
  const target = new THREE.WebGLRenderTarget(width, height, { type: THREE.FloatType, samples: 4 });
  renderer.setRenderTarget(target);
  renderer.render(lit(given, objects), camera);
  const read = new Float32Array(width * height * 4);
  renderer.readRenderTargetPixels(target, 0, 0, width, height, read);
  renderer.setRenderTarget(null);
  target.dispose();
  const rows = [];
  for (let row = height - 1; row >= 0; row -= 1) {
    for (let i = row * width; i < (row + 1) * width; i += 1) {
      rows.push(read[4 * i], read[4 * i + 1], read[4 * i + 2]);
    }
  }
  return { width, height, values: rows };
}
