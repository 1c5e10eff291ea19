// The arrays of the room, as host/apps/publish/sections.cpp codes them.

const room = JSON.parse(document.getElementById('room').textContent);

/// Bytes of base64 text.
function bytesOf(text) {
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

async function inflate(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/// Numbers of `size` bytes each, whose bytes lie in planes.
function joinPlanes(bytes, size) {
  const count = bytes.length / size;
  const numbers = size === 2 ? new Uint16Array(count) : new Uint32Array(count);
  for (let i = 0; i < count; ++i) {
    let number = 0;
    for (let plane = size - 1; plane >= 0; --plane) {
      number = (number << 8) | bytes[plane * count + i];
    }
    numbers[i] = number;
  }
  return numbers;
}

const unzigzag = (code) => (code & 1 ? -(code + 1) / 2 : code / 2);

/// Adds what the texels to the left, above and at the corner predict: the median edge detector.
function addPredictions(plane, width, mask) {
  for (let i = 0; i < plane.length; ++i) {
    const x = i % width;
    const left = x > 0 ? plane[i - 1] : 0;
    const above = i >= width ? plane[i - width] : 0;
    const corner = x > 0 && i >= width ? plane[i - width - 1] : 0;
    const low = Math.min(left, above), high = Math.max(left, above);
    const predicted = corner >= high ? low : corner <= low ? high : left + above - corner;
    plane[i] = (plane[i] + predicted) & mask;
  }
}

/// Packs linear colours into the format RGB9_E5 of WebGL.
const packing = (() => {
  const float = new Float32Array(1);
  return {float, bits: new Uint32Array(float.buffer)};
})();
function rgb9e5(r, g, b) {
  const {float, bits} = packing;
  float[0] = Math.max(r, g, b);
  let exponent = Math.max(-15, (bits[0] >>> 23) - 126);
  let scale = 2 ** (9 - exponent);
  if (Math.round(float[0] * scale) > 511) {
    ++exponent;
    scale /= 2;
  }
  return ((Math.round(r * scale) | (Math.round(g * scale) << 9) | (Math.round(b * scale) << 18) |
           ((exponent + 15) << 27)) >>> 0);
}

const powersOfTwo = Float64Array.from({length: 64}, (_, exponent) => 2 ** (exponent - 24));
/// What a packed texel holds, into `colour`.
function unpack(texel, colour) {
  const scale = powersOfTwo[texel >>> 27];
  colour[0] = (texel & 511) * scale;
  colour[1] = ((texel >>> 9) & 511) * scale;
  colour[2] = ((texel >>> 18) & 511) * scale;
}

/// Texels of a picture of light.
///   brightest   luminance
function decodeLight(bytes, width, brightest = 1) {
  const {steps, octaves, chroma} = room.coding;
  const words = joinPlanes(bytes, 2);
  const count = words.length / 3;
  const planes = [0, 1, 2].map((plane) => {
    const values = new Int32Array(count);
    for (let i = 0; i < count; ++i) values[i] = unzigzag(words[plane * count + i]);
    addPredictions(values, width, -1);
    return values;
  });
  const luminances = Float64Array.from({length: steps * octaves + 1},
                                       (_, code) => (code ? brightest * 2 ** (code / steps - octaves) : 0));
  const texels = new Uint32Array(count);
  for (let i = 0; i < count; ++i) {
    if (planes[0][i] === 0) continue;
    const red = planes[1][i] / chroma, blue = planes[2][i] / chroma;
    const green = Math.max(0, 1 - red - blue);
    const scale =
        luminances[planes[0][i]] / (0.2126 * red + 0.7152 * green + 0.0722 * blue);
    texels[i] = rgb9e5(scale * red, scale * green, scale * blue);
  }
  return texels;
}

function decodeTexture(bytes, width) {
  const count = bytes.length / 4;
  const texels = new Uint8Array(bytes.length);
  for (let channel = 0; channel < 4; ++channel) {
    const plane = new Int32Array(bytes.subarray(channel * count, (channel + 1) * count));
    addPredictions(plane, width, 255);
    for (let i = 0; i < count; ++i) texels[4 * i + channel] = plane[i];
  }
  for (let i = 0; i < bytes.length; i += 4) {  // red and blue are coded as differences from green
    texels[i] += texels[i + 1] - 128;
    texels[i + 2] += texels[i + 1] - 128;
  }
  return texels;
}

function decodeIndices(bytes) {
  const numbers = joinPlanes(bytes, 4);
  let before = 0;
  for (let i = 0; i < numbers.length; ++i) {
    before += unzigzag(numbers[i]);
    numbers[i] = before;
  }
  return numbers;
}

/// Gives arrays by their names.
class Archive {
  constructor() {
    const element = document.getElementById('data');
    this.bytes = bytesOf(element.textContent.trim());
    element.remove();
  }

  has(name) { return name in room.sections; }

  ///   width   of a picture
  async array(name, width) {
    const section = room.sections[name];
    const bytes = await inflate(this.bytes.subarray(section.at, section.at + section.packed));
    switch (section.coding) {
      case 'floats': return new Float32Array(joinPlanes(bytes, 4).buffer);
      case 'words': return joinPlanes(bytes, 2);
      case 'indices': return decodeIndices(bytes);
      case 'light': return decodeLight(bytes, width);
      case 'texture': return decodeTexture(bytes, width);
      default: return bytes;
    }
  }
}
