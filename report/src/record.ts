import type { Clock } from "./clock";
import { el } from "./dom";

const kTypes = ["video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm", "video/mp4"];
const kRate = 30; // frames per second
const kBits = 8e6; // bits per second

/// A button that plays the motion once from its start and saves the view as a video. Null if the
/// browser cannot.
export function recordButton(canvas: HTMLCanvasElement, clock: Clock, name: string): HTMLButtonElement | null {
  if (typeof MediaRecorder === "undefined" || !("captureStream" in canvas)) return null;
  const type = kTypes.find((one) => MediaRecorder.isTypeSupported(one));
  if (!type) return null;
  const button = el("button", { type: "button", class: "record" }, "Record");
  button.title = "Play from the start and save the view as a video";
  let recorder: MediaRecorder | null = null;
  const show = () => {
    button.textContent = recorder ? "Stop" : "Record";
    button.classList.toggle("on", recorder !== null);
  };
  button.addEventListener("click", () => {
    if (recorder) {
      recorder.stop();
      return;
    }
    const parts: Blob[] = [];
    const stream = canvas.captureStream(kRate);
    recorder = new MediaRecorder(stream, { mimeType: type, videoBitsPerSecond: kBits });
    recorder.addEventListener("dataavailable", (event) => parts.push(event.data));
    recorder.addEventListener("stop", () => {
      recorder = null;
      clock.pause();
      for (const track of stream.getTracks()) track.stop();
      save(new Blob(parts, { type }), `${name}.${type.includes("mp4") ? "mp4" : "webm"}`);
      show();
    });
    clock.seek(0);
    recorder.start();
    clock.play();
    show();
  });
  clock.onChange(() => {
    if (recorder?.state === "recording" && !clock.playing && clock.time > 0) recorder.stop();
  });
  return button;
}

function save(blob: Blob, name: string): void {
  const link = el("a", { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}
