/// Step of an arrow key [s].
export const kFrame = 0.01;

/// Common time of scene, time line and charts. Plays at `speed` times real time, stops at the end.
export class Clock {
  time = 0;
  playing = false;
  speed = 1;
  private last = 0;
  private readonly listeners: (() => void)[] = [];

  constructor(public end: number) {}

  /// Called whenever time, speed or playing change.
  onChange(listener: () => void): void {
    this.listeners.push(listener);
  }
  seek(time: number): void {
    this.time = Math.min(Math.max(time, 0), this.end);
    this.tell();
  }
  /// Sets the end of a new motion; keeps the time if possible.
  setEnd(end: number): void {
    this.end = end;
    this.seek(this.time);
  }
  pause(): void {
    this.playing = false;
    this.tell();
  }
  play(): void {
    if (this.time >= this.end) this.time = 0;
    this.playing = true;
    this.last = performance.now();
    requestAnimationFrame(this.step);
    this.tell();
  }
  toggle(): void {
    if (this.playing) this.pause();
    else this.play();
  }
  setSpeed(speed: number): void {
    this.speed = speed;
    this.tell();
  }

  private readonly step = (now: number): void => {
    if (!this.playing) return;
    // A page in the background gets no frames: limit the step.
    const elapsed = Math.min(Math.max(now - this.last, 0), 250) / 1000;
    this.last = now;
    this.time = Math.min(this.time + elapsed * this.speed, this.end);
    if (this.time >= this.end) this.playing = false;
    else requestAnimationFrame(this.step);
    this.tell();
  };
  private tell(): void {
    for (const listener of this.listeners) listener();
  }
}
