// The scene of three.js's own example of order-independent transparency: an opaque knot, three planes that cut through
// one another, and four balls around them.

import * as THREE from "three/webgpu";

export function makeScene(opacity = 0.5) {
  const scene = new THREE.Scene();
  scene.background = new THREE.Color(0x202020);
  scene.add(new THREE.HemisphereLight(0xffffff, 0x444444, 1.5));
  const sun = new THREE.DirectionalLight(0xffffff, 2.5);
  sun.position.set(4, 10, 6);
  scene.add(sun);
  const solid = new THREE.MeshStandardMaterial({ color: 0xffffff, roughness: 0.2 });
  scene.add(new THREE.Mesh(new THREE.TorusKnotGeometry(1, 0.4, 128, 32), solid));

  const clear = (color, roughness, side) =>
    new THREE.MeshStandardMaterial({ color, roughness, side, transparent: true, opacity });
  [0xff4030, 0x30d060, 0x3070ff].forEach((color, i) => {
    const plane = new THREE.Mesh(new THREE.PlaneGeometry(6, 6), clear(color, 0.5, THREE.DoubleSide));
    plane.rotation.y = (i * Math.PI) / 3;
    scene.add(plane);
  });
  const balls = new THREE.Group();
  [0xffc020, 0xd040d0, 0x40c0d0, 0xa0d040].forEach((color, i) => {
    const ball = new THREE.Mesh(new THREE.SphereGeometry(0.8, 32, 16), clear(color, 0.3, THREE.FrontSide));
    ball.position.set(2.5 * Math.cos((i * Math.PI) / 2), 0, 2.5 * Math.sin((i * Math.PI) / 2));
    balls.add(ball);
  });
  scene.add(balls);
  return { scene, balls };
}

export function makeCamera(aspect) {
  const camera = new THREE.PerspectiveCamera(45, aspect, 0.1, 100);
  camera.position.set(8, 4, 10);
  camera.lookAt(0, 0, 0);
  camera.updateMatrixWorld();
  return camera;
}
