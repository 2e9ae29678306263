// player.ts — the clock of the playback: time runs while playing and seen, stops at the end.

export class Player {
  time: number;
  speed = 1;
  private request = 0;
  private last = 0;

  /** @param changed  called after every change of time or of playing */
  constructor(
    private start: number,
    private end: number,
    private readonly seen: () => boolean,
    private readonly changed: () => void,
  ) {
    this.time = end;
  }

  get playing(): boolean {
    return this.request !== 0;
  }

  get range(): readonly [number, number] {
    return [this.start, this.end];
  }

  /** Another motion; time stays where it is as far as the new one reaches. */
  setRange(start: number, end: number): void {
    const atEnd = this.time >= this.end;
    this.start = start;
    this.end = end;
    this.seek(atEnd ? end : this.time);
  }

  seek(time: number): void {
    this.time = Math.min(this.end, Math.max(this.start, time));
    this.changed();
  }

  toggle(): void {
    if (this.playing) this.pause();
    else this.play();
  }

  play(): void {
    if (this.playing || this.end <= this.start) return;
    if (this.time >= this.end) this.time = this.start;
    this.last = performance.now();
    this.request = requestAnimationFrame((now) => this.tick(now));
    this.changed();
  }

  pause(): void {
    cancelAnimationFrame(this.request);
    this.request = 0;
    this.changed();
  }

  private tick(now: number): void {
    const passed = Math.min(0.1, Math.max(0, now - this.last) / 1000);
    this.last = now;
    if (!this.seen()) return this.pause();
    const next = this.time + passed * this.speed;
    if (next >= this.end) {
      this.time = this.end;
      return this.pause();
    }
    this.time = next;
    this.request = requestAnimationFrame((again) => this.tick(again));
    this.changed();
  }
}

const SPEEDS = [0.05, 0.1, 0.25, 0.5, 1, 2, 5, 10, 25, 100];

/** Speeds to offer, and the one at which a motion of this length lasts nearest to four seconds. */
export function speedsFor(duration: number): { speeds: readonly number[]; preferred: number } {
  const wanted = duration > 0 ? duration / 4 : 1;
  const off = (speed: number) => Math.abs(Math.log(speed / wanted));
  const preferred =
    duration >= 1 && duration <= 8 ? 1 : SPEEDS.reduce((best, speed) => (off(speed) < off(best) ? speed : best), 1);
  const index = SPEEDS.indexOf(preferred);
  const first = Math.max(0, Math.min(index - 2, SPEEDS.indexOf(1)));
  const last = Math.min(SPEEDS.length, Math.max(index + 3, SPEEDS.indexOf(1) + 1));
  return { speeds: SPEEDS.slice(first, last), preferred };
}
