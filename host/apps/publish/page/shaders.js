// The programs of the graphics processor. Colours are linear with Rec.709 primaries; light is in
// units of white on the display at the exposure that the page was opened with. The room is drawn as
// light, or as its illuminance, and Screen (display.js) shows it.

/// What the fragments of the room and of the sky are: light, or its luminance on matt surface and 1, elsewhere 0.
const shaderMode = `
const int asIlluminance = 2;
uniform int uMode;
`;

const shaderRoom = {
  vertex: `#version 300 es
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 3) in vec2 lightUv;
layout(location = 4) in uvec2 kind;   // material, light that shines here
uniform mat4 uCamera;
uniform sampler2D uMaterials, uEmitters;
out vec3 vPosition, vNormal;
out vec2 vUv, vLightUv;
flat out vec4 vAlbedo, vSpecular;     // with the alpha cutoff, the GGX alpha
flat out vec4 vEmission;              // with F90
flat out vec2 vGlass;                 // index of refraction, 1 where it is thin
void main() {
  vPosition = position;
  vNormal = normal;
  vUv = uv;
  vLightUv = lightUv;
  vAlbedo = texelFetch(uMaterials, ivec2(0, kind.x), 0);
  vSpecular = texelFetch(uMaterials, ivec2(1, kind.x), 0);
  vEmission = vec4(texelFetch(uEmitters, ivec2(kind.y, 0), 0).rgb,
                   texelFetch(uMaterials, ivec2(2, kind.x), 0).r);
  vGlass = texelFetch(uMaterials, ivec2(2, kind.x), 0).gb;
  gl_Position = uCamera * vec4(position, 1.0);
}`,
  fragment: `#version 300 es
precision highp float;
precision highp int;
in vec3 vPosition, vNormal;
in vec2 vUv, vLightUv;
flat in vec4 vAlbedo, vSpecular, vEmission;
flat in vec2 vGlass;
uniform sampler2D uLight, uTexture;
uniform highp samplerCube uSurroundings;
uniform vec3 uEye, uProbe, uLow, uHigh;   // the probe's place, and the box that it stands for
uniform float uProbeLevels;               // 0 while there is no probe
uniform int uTextured;                    // 1 colour, 2 emission
uniform int uInteraction;                 // 0 opaque, 1 mirror, 2 glass
uniform int uLayer;                       // 0 what is there, 1 what passes it, 2 all but that
out vec4 fragment;
${shaderMode}
const float largest = 60000.0;            // that half floats hold
// GGX alpha: a lobe above it is so wide that it reflects no more than the mean of what lights the surface, where the probe
// may see a window that the surface does not.
const float rough = 0.1;
// What comes from a direction, from a cube map that stands for a box (Lagarde and Zanuttini, "Local
// image-based lighting with parallax-corrected cubemaps", 2012).
vec3 reflected(vec3 direction, float alpha) {
  if (uProbeLevels == 0.0) return vec3(0.0);
  vec3 safe = mix(direction, vec3(1e-6), lessThan(abs(direction), vec3(1e-6)));
  vec3 far = max((uLow - vPosition) / safe, (uHigh - vPosition) / safe);
  vec3 place = vPosition + direction * min(far.x, min(far.y, far.z));
  return textureLod(uSurroundings, place - uProbe, sqrt(alpha) * (uProbeLevels - 2.0)).rgb;
}

// Of unpolarised light at a smooth boundary, and of a pane, between whose two faces light bounces
// (host/renderer/trace/scatter.cpp).
float fresnel(float cosine, float index) {
  float within = sqrt(max(0.0, 1.0 - (1.0 - cosine * cosine) / (index * index)));
  float perpendicular = (cosine - index * within) / (cosine + index * within);
  float parallel = (index * cosine - within) / (index * cosine + within);
  return 0.5 * (perpendicular * perpendicular + parallel * parallel);
}

void main() {
  vec4 texel = uTextured > 0 ? texture(uTexture, vUv) : vec4(1.0);
  float alpha = vAlbedo.a < 0.0 ? texel.a * -vAlbedo.a : 1.0;
  if (vAlbedo.a > 0.0 && texel.a < vAlbedo.a) discard;
  vec3 light = texture(uLight, vLightUv).rgb;
  if (uMode == asIlluminance) {
    float known = uInteraction == 0 ? 1.0 : 0.0;
    fragment = vec4(known * min(dot(light, vec3(0.2126, 0.7152, 0.0722)), largest), known, 0.0, alpha);
    return;
  }
  vec3 albedo = vAlbedo.rgb * (uTextured == 1 ? texel.rgb : vec3(1.0));
  vec3 emission = vEmission.rgb * (uTextured == 2 ? texel.rgb : vec3(1.0));
  vec3 radiance = albedo * light * 0.31830988618 + emission;
  vec3 view = normalize(uEye - vPosition);
  if (uInteraction != 0 || vSpecular.r + vSpecular.g + vSpecular.b > 0.0) {
    vec3 normal = normalize(vNormal);
    if (dot(normal, view) < 0.0) normal = -normal;
    float facing = clamp(dot(normal, view), 0.0, 1.0);
    vec3 direction = reflect(-view, normal);
    if (uInteraction == 1) {
      radiance = vSpecular.rgb * reflected(direction, 0.0);
    } else if (uInteraction == 2) {
      float part = fresnel(max(facing, 1e-4), vGlass.x);
      if (vGlass.y > 0.0) part = 2.0 * part / (1.0 + part);
      fragment = vec4(uLayer == 1 ? (1.0 - part) * vAlbedo.rgb
                                  : min(part * reflected(direction, 0.0), largest), 1.0);
      return;
    } else {
      // The environment's part of a GGX lobe, fitted (Karis, "Physically based shading on mobile",
      // 2014).
      float roughness = sqrt(vSpecular.a);
      vec4 r = roughness * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
      float a = min(r.x * r.x, exp2(-9.28 * facing)) * r.x + r.y;
      vec2 lobe = vec2(-1.04, 1.04) * a + r.zw;
      vec3 part = vSpecular.rgb * lobe.x + vEmission.a * lobe.y;
      vec3 coat = reflected(direction, vSpecular.a);
      if (vSpecular.a > rough) coat = min(coat, light * 0.31830988618);
      radiance = radiance * (1.0 - part) + part * coat;
    }
  }
  radiance = min(radiance, largest);
  fragment = uLayer == 0 ? vec4(radiance, alpha)
             : vec4(uLayer == 1 ? vec3(1.0 - alpha) : alpha * radiance, 1.0);
}`,
};

/// The sky, where nothing is in front of it.
const shaderSky = {
  vertex: `#version 300 es
uniform mat4 uRays;    // from the corners of the picture to directions
out vec3 vDirection;
void main() {
  vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  vDirection = (uRays * vec4(corner, 1.0, 1.0)).xyz;
  gl_Position = vec4(corner, 1.0, 1.0);
}`,
  fragment: `#version 300 es
precision highp float;
precision highp int;
in vec3 vDirection;
uniform sampler2D uPatches, uEnvironment;
uniform vec3 uEnvironmentLight;
uniform vec4 uSuns[4];          // direction to it, cosine of its radius
uniform vec3 uSunLights[4];
out vec4 fragment;
${shaderMode}
void main() {
  vec3 d = normalize(vDirection);
  vec2 place = vec2(atan(d.x, -d.z) * 0.15915494309 + 0.5, acos(clamp(d.y, -1.0, 1.0)) * 0.31830988618);
  vec3 radiance = texture(uPatches, place).rgb +
                  uEnvironmentLight * textureLod(uEnvironment, place, 0.0).rgb;
  for (int i = 0; i < 4; ++i) {
    if (dot(d, uSuns[i].xyz) > uSuns[i].w) radiance += uSunLights[i];
  }
  fragment = vec4(uMode == asIlluminance ? vec3(0.0) : min(radiance, 60000.0), 1.0);
}`,
};

/// Sums light maps with their powers: what the sliders say becomes one texture.
const shaderMix = {
  vertex: `#version 300 es
void main() {
  gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}`,
  fragment: `#version 300 es
precision highp float;
precision highp int;
precision highp sampler2DArray;
uniform sampler2DArray uMaps;
uniform sampler2D uWeights;    // colour, layer of uMaps
uniform int uFirst, uCount;
out vec4 fragment;
void main() {
  vec3 sum = vec3(0.0);
  for (int i = 0; i < uCount; ++i) {
    vec4 weight = texelFetch(uWeights, ivec2(uFirst + i, 0), 0);
    sum += weight.rgb * texelFetch(uMaps, ivec3(gl_FragCoord.xy, int(weight.a)), 0).rgb;
  }
  fragment = vec4(min(sum, 60000.0), 1.0);
}`,
};

const shaderCopy = {
  vertex: shaderMix.vertex,
  fragment: `#version 300 es
precision highp float;
uniform sampler2D uPicture;
out vec4 fragment;
void main() { fragment = texelFetch(uPicture, ivec2(gl_FragCoord.xy), 0); }`,
};
