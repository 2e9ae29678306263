// reader.ts — numbers of a binary message one after the other, little-endian. What is cut short throws a RangeError.
//
// Lists of u32 and vec3 are copies, which stay when the message goes; those of u8 and i16 are views of its bytes.

export class Reader {
  private at = 0;
  private readonly view: DataView;

  constructor(private readonly buffer: ArrayBuffer) {
    this.view = new DataView(buffer);
  }

  /** Bytes that have not been read. */
  get left(): number {
    return this.buffer.byteLength - this.at;
  }

  /** Moves on by so many bytes; where these begin. */
  private take(bytes: number): number {
    if (bytes > this.left) throw new RangeError("a message that was cut short");
    this.at += bytes;
    return this.at - bytes;
  }

  u8 = (): number => this.view.getUint8(this.take(1));
  u32 = (): number => this.view.getUint32(this.take(4), true);
  f32 = (): number => this.view.getFloat32(this.take(4), true);
  f64 = (): number => this.view.getFloat64(this.take(8), true);
  vec3 = (): [number, number, number] => [this.f32(), this.f32(), this.f32()];

  u8s = (count: number): Uint8Array => new Uint8Array(this.buffer, this.take(count), count);
  i16s = (count: number): Int16Array => new Int16Array(this.buffer, this.take(2 * count), count);
  u32s = (count: number): Uint32Array => new Uint32Array(this.copy(4 * count));
  vec3s = (count: number): Float32Array => new Float32Array(this.copy(12 * count));
  f32s = (count: number): number[] => this.list(count, this.f32);

  private copy(bytes: number): ArrayBuffer {
    const from = this.take(bytes);
    return this.buffer.slice(from, from + bytes);
  }

  string(): string {
    const text = new TextDecoder().decode(this.u8s(this.u32()));
    this.pad();
    return text;
  }

  /** On to a multiple of 4. */
  pad(): void {
    this.take((4 - (this.at % 4)) % 4);
  }

  list<T>(count: number, read: () => T): T[] {
    const all: T[] = [];
    for (let i = 0; i < count; i++) all.push(read());
    return all;
  }

  /** Null where the message has ended. */
  optional<T>(read: () => T): T | null {
    return this.left >= 4 ? read() : null;
  }
}
