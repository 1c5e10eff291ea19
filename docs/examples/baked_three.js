// Shows what `photile bake` wrote in three.js, each light by a slider:
//
//   const room = await loadBaked(renderer, 'baked.gltf');
//   scene.add(room.scene);
//   room.setPower(0, 0.5);   // half of what room.lights[0].power says
//
// The light maps are summed into one texture when a power changes, so that a frame costs the same with
// two lights and with two hundred. docs/examples/baked_three.html is a page of it.
import * as THREE from 'three';
import {EXRLoader} from 'three/addons/loaders/EXRLoader.js';
import {GLTFLoader} from 'three/addons/loaders/GLTFLoader.js';

// Rows of a loaded picture run upwards; texture coordinates of glTF run downwards.
const vertexShader = `varying vec2 at;
void main() { at = vec2(uv.x, 1.0 - uv.y); gl_Position = vec4(position.xy, 0.0, 1.0); }`;
const fragmentShader = `uniform sampler2D map; uniform float power; varying vec2 at;
void main() { gl_FragColor = vec4(power * texture2D(map, at).rgb, 1.0); }`;

const load = (loader, url) => new Promise((done, failed) => loader.load(url, done, undefined, failed));

export async function loadBaked(renderer, url) {
  const gltf = await load(new GLTFLoader(), url);
  const lights = gltf.scene.userData.photile.light_maps.map((light) => ({...light, factor: 1}));
  const folder = THREE.LoaderUtils.extractUrlBase(url);
  const maps = await Promise.all(lights.map(({uri}) =>
      load(new EXRLoader().setDataType(THREE.FloatType), folder + uri)));
  const {width, height} = maps[0].image;
  const sum = new THREE.WebGLRenderTarget(width, height, {
    type: THREE.HalfFloatType, depthBuffer: false, generateMipmaps: false});
  sum.texture.channel = 1;  // TEXCOORD_1

  const adding = new THREE.ShaderMaterial({
    vertexShader, fragmentShader, uniforms: {map: {value: null}, power: {value: 1}}, depthTest: false,
    blending: THREE.CustomBlending, blendSrc: THREE.OneFactor, blendDst: THREE.OneFactor});
  const square = new THREE.Mesh(new (THREE.PlaneBufferGeometry ?? THREE.PlaneGeometry)(2, 2), adding);
  square.frustumCulled = false;
  const quad = new THREE.Scene().add(square);
  const camera = new THREE.Camera();
  function mix() {
    const before = [renderer.autoClear, renderer.getRenderTarget()];
    renderer.autoClear = false;
    renderer.setRenderTarget(sum);
    renderer.setClearColor(0, 1);
    renderer.clear();
    maps.forEach((map, i) => {
      adding.uniforms.map.value = map;
      adding.uniforms.power.value = lights[i].factor;
      if (lights[i].factor > 0) renderer.render(quad, camera);
    });
    renderer.autoClear = before[0];
    renderer.setRenderTarget(before[1]);
  }

  // A matt surface of colour c under irradiance E has the radiance c E / pi. Old releases do not divide.
  const divides = THREE.ShaderLib.basic.fragmentShader.includes('RECIPROCAL_PI');
  gltf.scene.traverse((mesh) => {
    if (!mesh.isMesh) return;
    const {map, color} = mesh.material;
    mesh.material = new THREE.MeshBasicMaterial({
      map, color, lightMap: sum.texture, lightMapIntensity: divides ? 1 : 1 / Math.PI});
  });
  mix();
  return {scene: gltf.scene, lights, setPower(i, factor) { lights[i].factor = factor; mix(); }};
}
