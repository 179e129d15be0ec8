// SPDX-License-Identifier: Apache-2.0
// The data of an exported page. Each is a script NAME.js that hands its bytes to the page, because a page that was
// opened from the disk may load scripts, but no other data.

import { element } from "../element";

declare global {
  interface Window {
    lfvisualizerFile?: (name: string, base64: string) => void;
  }
}

// True if this is an exported page. Tests without a page have no document.
export function hasScripts(): boolean {
  return typeof document !== "undefined" && document.documentElement.dataset.files === "scripts";
}

const waiting = new Map<string, ((bytes: Uint8Array<ArrayBuffer>) => void)[]>();

// Returns the bytes of the data NAME; null if there is no script NAME.js.
export function loadScript(name: string): Promise<Uint8Array<ArrayBuffer> | null> {
  window.lfvisualizerFile ??= (loaded, base64) => {
    const bytes = bytesOfBase64(base64);
    for (const take of waiting.get(loaded) ?? []) take(bytes);
    waiting.delete(loaded);
  };
  return new Promise((resolve) => {
    waiting.set(name, [...(waiting.get(name) ?? []), resolve]);
    const script = element("script", { src: `${name}.js` });
    script.addEventListener("load", () => script.remove());
    script.addEventListener("error", () => {
      script.remove();
      waiting.delete(name);
      resolve(null);
    });
    document.head.append(script);
  });
}

export function bytesOfBase64(text: string): Uint8Array<ArrayBuffer> {
  const letters = atob(text);
  const bytes = new Uint8Array(letters.length);
  for (let i = 0; i < letters.length; ++i) bytes[i] = letters.charCodeAt(i);
  return bytes;
}
