// scene_state.ts — what the figures of one scene share: hidden variants, the one that is highlighted, and where the mesh's
// playback stands.

export interface Playhead {
  variant: string;
  time: number; // [s]
}

export class SceneState {
  private readonly hidden = new Set<string>();
  private readonly changeListeners = new Set<() => void>();
  private readonly playheadListeners = new Set<() => void>();
  private head: Playhead | null = null;
  private pointed: string | null = null;
  private pinned: string | null = null;

  constructor(private readonly variants: readonly string[]) {}

  isHidden(variant: string): boolean {
    return this.hidden.has(variant);
  }

  /** Shows or hides a variant; `only` shows it alone, or all again where it is alone already. */
  toggle(variant: string, only: boolean): void {
    if (!only) {
      if (!this.hidden.delete(variant)) this.hidden.add(variant);
    } else {
      const alone = this.hidden.size === this.variants.length - 1 && !this.hidden.has(variant);
      this.hidden.clear();
      if (!alone) for (const other of this.variants) if (other !== variant) this.hidden.add(other);
    }
    for (const listener of this.changeListeners) listener();
  }

  /** Key of the lines that stand out (keyOf); null: all are alike. */
  get highlight(): string | null {
    return this.pointed ?? this.pinned;
  }

  /** While the pointer or the focus is on a line, it stands out; null: on none. */
  point(key: string | null): void {
    if (key === this.pointed) return;
    this.pointed = key;
    for (const listener of this.changeListeners) listener();
  }

  /** Keeps a line highlighted until it is chosen again, or another one. */
  pin(key: string): void {
    this.pinned = this.pinned === key ? null : key;
    for (const listener of this.changeListeners) listener();
  }

  get playhead(): Playhead | null {
    return this.head;
  }

  setPlayhead(head: Playhead | null): void {
    this.head = head;
    for (const listener of this.playheadListeners) listener();
  }

  onChange(listener: () => void): () => void {
    this.changeListeners.add(listener);
    return () => this.changeListeners.delete(listener);
  }

  onPlayhead(listener: () => void): () => void {
    this.playheadListeners.add(listener);
    return () => this.playheadListeners.delete(listener);
  }
}
