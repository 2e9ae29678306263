// decode.ts — base64 of little-endian numbers into typed arrays, as the contract packs them.
//
// Typed arrays use the byte order of the machine; every machine with a browser we aim at is little-endian,
// and one that is not gets its bytes swapped here.

const LITTLE_ENDIAN = new Uint8Array(new Uint16Array([1]).buffer)[0] === 1;

/** Bytes of a base64 text; an empty or damaged text gives no bytes. */
export function decodeBytes(text: string | null | undefined): Uint8Array {
  if (!text) return new Uint8Array(0);
  let binary: string;
  try {
    binary = atob(text);
  } catch {
    return new Uint8Array(0);
  }
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; i++) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

/** The bytes in machine order, cut to whole numbers of `size` bytes. */
function machineOrder(bytes: Uint8Array, size: number): ArrayBuffer {
  const whole = bytes.slice(0, bytes.length - (bytes.length % size));
  if (!LITTLE_ENDIAN) {
    for (let i = 0; i < whole.length; i += size) whole.subarray(i, i + size).reverse();
  }
  return whole.buffer;
}

export function decodeU8(text: string | null | undefined): Uint8Array {
  return decodeBytes(text);
}

export function decodeU32(text: string | null | undefined): Uint32Array {
  return new Uint32Array(machineOrder(decodeBytes(text), 4));
}

export function decodeF32(text: string | null | undefined): Float32Array {
  return new Float32Array(machineOrder(decodeBytes(text), 4));
}

/** Quantised numbers: i16 / 32767 × scale. */
export function decodeI16Scaled(text: string | null | undefined, scale: number): Float32Array {
  const raw = new Int16Array(machineOrder(decodeBytes(text), 2));
  return Float32Array.from(raw, (value) => (value / 32767) * scale);
}

/** Quantised non-negative numbers: u8 / 255 × max. */
export function decodeU8Scaled(text: string | null | undefined, max: number): Float32Array {
  return Float32Array.from(decodeBytes(text), (value) => (value / 255) * max);
}
