// SPDX-License-Identifier: Apache-2.0
// Servers that stand between the browser and lfvisualizer in tests: a forwarded port, and nginx.
import { spawn } from "node:child_process";
import { existsSync } from "node:fs";
import { mkdir, readFile, writeFile } from "node:fs/promises";
import { connect, createServer } from "node:net";
import { join } from "node:path";

const NGINX = ["/usr/sbin/nginx", "/usr/bin/nginx", "/usr/local/sbin/nginx"];

export function findNginx() {
  return NGINX.find((path) => existsSync(path));
}

function listening(server, port = 0) {
  return new Promise((resolve) => server.listen(port, "127.0.0.1", () => resolve(server.address().port)));
}

export async function freePort() {
  const server = createServer();
  const port = await listening(server);
  await new Promise((resolve) => server.close(resolve));
  return port;
}

// Forwards the port `own` to another one byte by byte, as ssh -L does. Returns a function that ends this.
export async function forwardPort(own, port) {
  const sockets = new Set();
  const server = createServer((near) => {
    const far = connect(port, "127.0.0.1");
    for (const socket of [near, far]) {
      sockets.add(socket);
      socket.on("error", () => {});
      socket.on("close", () => (near.destroy(), far.destroy(), sockets.delete(socket)));
    }
    near.pipe(far).pipe(near);
  });
  await listening(server, own);
  return async () => {
    const closed = new Promise((resolve) => server.close(resolve));
    for (const socket of sockets) socket.destroy();
    await closed;
  };
}

async function answers(port) {
  return new Promise((resolve) => {
    const socket = connect(port, "127.0.0.1", () => (socket.destroy(), resolve(true)));
    socket.on("error", () => resolve(false));
  });
}

let count = 0;

// Starts nginx at the port `own`, and forwards its folder /fields/ to another port. Returns a function that ends it.
//   folder  for its files
//   lines   further lines of the location
export async function startNginx(folder, own, port, lines = "") {
  const here = join(folder, `nginx-${++count}`);
  await mkdir(here);
  const kinds = ["client_body", "proxy", "fastcgi", "uwsgi", "scgi"];
  const temporaries = kinds.map((kind) => `  ${kind}_temp_path ${here}/${kind};\n`).join("");
  const text = `daemon off;
master_process off;
pid ${here}/pid;
error_log ${here}/errors;
events { worker_connections 64; }
http {
  access_log off;
${temporaries}  server {
    listen 127.0.0.1:${own};
    location /fields/ {
      proxy_pass http://127.0.0.1:${port}/;
      ${lines}
    }
  }
}
`;
  await writeFile(join(here, "conf"), text);
  const child = spawn(findNginx(), ["-p", here, "-c", join(here, "conf"), "-e", join(here, "errors")], {
    stdio: "ignore",
  });
  let isThere = true;
  const ended = new Promise((resolve) => child.on("close", () => resolve((isThere = false))));
  while (isThere && !(await answers(own))) await new Promise((resolve) => setTimeout(resolve, 30));
  if (!isThere) throw new Error(`nginx: ${await readFile(join(here, "errors"), "utf8")}`);
  return async () => {
    child.kill("SIGTERM");
    await ended;
  };
}
