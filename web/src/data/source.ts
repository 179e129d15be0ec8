// SPDX-License-Identifier: Apache-2.0
// Reads the page's data by their names, relative to the folder of the page. They come from the server of lfvisualizer
// or from exported files.

import { hasScripts, loadScript } from "./script_files";

export class SourceError extends Error {
  //   status  of HTTP; 0: there is no answer; 200: lfvisualizer found a mistake of the user
  constructor(
    message: string,
    readonly status: number,
    readonly isConflict = false,
  ) {
    super(message);
  }
}

async function refusal(response: Response): Promise<SourceError> {
  const text = await response.text();
  try {
    const json = JSON.parse(text) as { error?: unknown };
    if (typeof json.error === "string") return new SourceError(json.error, response.status);
  } catch {
    // The answer is not JSON, so it is not from lfvisualizer. The error below then states only the HTTP status.
  }
  const status = `${response.status} ${response.statusText}`.trim();
  return new SourceError(`a server before lfvisualizer, such as a reverse proxy, answers ${status}`, response.status);
}

async function ask(name: string, options?: RequestInit): Promise<Response> {
  if (hasScripts()) {
    const bytes = options ? null : await loadScript(name);
    if (!bytes) throw new SourceError(`the exported files have no ${name}`, 404);
    return new Response(bytes);
  }
  let response: Response;
  try {
    response = await fetch(name, options);
  } catch {
    throw new SourceError("lfvisualizer does not answer: has it been ended?", 0);
  }
  if (!response.ok) throw await refusal(response);
  return response;
}

export async function getJson<T>(name: string): Promise<T> {
  return (await (await ask(name)).json()) as T;
}

export async function getText(name: string): Promise<string> {
  return (await ask(name)).text();
}

let bytesReceived = 0;

// Returns the total size of the arrays received so far, for measurements.
export function receivedBytes(): number {
  return bytesReceived;
}

export async function getBytes(name: string): Promise<ArrayBuffer> {
  const bytes = await (await ask(name)).arrayBuffer();
  bytesReceived += bytes.byteLength;
  return bytes;
}

function send(name: string, body: object): Promise<Response> {
  return ask(name, { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(body) });
}

async function jsonOf<T>(response: Response): Promise<T> {
  const json = (await response.json()) as T & { error?: unknown; conflict?: unknown };
  if (typeof json.error === "string") throw new SourceError(json.error, response.status, json.conflict === true);
  return json;
}

// Posts a request and returns its answer. Throws a SourceError also if the user made a mistake: the server then answers
// without an HTTP error, but with a key "error".
export async function post<T>(name: string, body: object): Promise<T> {
  return jsonOf(await send(name, body));
}

// Posts a request that is answered by an array, or by JSON that says why there is none. Throws as post() does.
export async function postForBytes<T>(name: string, body: object): Promise<ArrayBuffer | T> {
  const response = await send(name, body);
  if (response.headers.get("Content-Type")?.startsWith("application/json")) return jsonOf<T>(response);
  const bytes = await response.arrayBuffer();
  bytesReceived += bytes.byteLength;
  return bytes;
}

// Receives server-sent events and calls the handler of their kind. If the connection breaks, the browser reconnects by
// itself. A hidden page closes its connection, because a browser has only six connections to an address for all its
// pages.
//   onConnection  called with true after each connect, with false when the connection breaks
export function listen(
  handlers: Record<string, (data: string) => void>,
  onConnection: (isThere: boolean) => void,
): void {
  let source: EventSource | null = null;
  const connect = () => {
    if (source && !document.hidden) return;
    source?.close();
    source = document.hidden ? null : new EventSource("events");
    if (!source) return;
    for (const [kind, handler] of Object.entries(handlers))
      source.addEventListener(kind, (event) => handler((event as MessageEvent<string>).data));
    source.addEventListener("open", () => onConnection(true));
    source.addEventListener("error", () => onConnection(false));
  };
  document.addEventListener("visibilitychange", connect);
  connect();
}
