// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";

import type { LivePicture } from "../../src/data/live_picture";
import { ChosenPictures, type LocalPictures } from "../../src/live/chosen_pictures";
import type { Wish } from "../../src/live/gl/wish";
import type { Pictures } from "../../src/live/pictures";
import { cameraAt } from "./test_camera";

const STILL = { camera: cameraAt([0, 0, 0]), width: 96, budget_ms: null, recordedOnly: false };
const QUICK = { ...STILL, budget_ms: 40 };

let now_ms = 0;

function chosen(server: Pictures, wish: Wish, open: (lost: () => void) => LocalPictures, loaded = () => {}) {
  return new ChosenPictures(server, wish, open, loaded, () => now_ms);
}

// Pictures that take some time. `isReady` false: LF images are lacking.
class Fake implements LocalPictures {
  isSoftware = false;
  name = "a card";
  isClosed = false;
  isReady = true;
  fault = "";
  asked = 0;

  constructor(
    private readonly by: LivePicture["by"],
    private readonly time_ms: number,
  ) {}

  async ask(): Promise<LivePicture | null> {
    ++this.asked;
    now_ms += this.time_ms;
    await Promise.resolve();
    if (this.fault) throw new Error(this.fault);
    return this.isReady ? ({ by: this.by } as LivePicture) : null;
  }

  close(): void {
    this.isClosed = true;
  }
}

async function by(pictures: Pictures, request = STILL): Promise<string | undefined> {
  return (await pictures.ask(request))?.by;
}

test("a faster WebGL renders after it was compared with the server in a still picture", async () => {
  const local = new Fake("webgl", 0);
  const pictures = chosen(new Fake("server", 60), "auto", () => local);
  assert.equal(await by(pictures, QUICK), "server");
  assert.equal(local.asked, 0);
  local.isReady = false;
  assert.equal(await by(pictures), "server");
  local.isReady = true;
  assert.equal(await by(pictures), "server");
  assert.equal(await by(pictures), "webgl");
  assert.equal(await by(pictures, QUICK), "webgl");
  local.isReady = false;
  assert.equal(await by(pictures), "server");
  local.isReady = true;
  assert.equal(await by(pictures), "webgl");
  assert.equal(pictures.reason, "");
});

test("a slower WebGL is closed", async () => {
  const local = new Fake("webgl", 60);
  const pictures = chosen(new Fake("server", 0), "auto", () => local);
  assert.equal(await by(pictures), "server");
  assert.ok(local.isClosed);
  assert.match(pictures.reason, /WebGL takes \d+ ms, the server \d+ ms/);
  assert.equal(await by(pictures), "server");
  assert.equal(local.asked, 2);
});

test("software renders only if it is asked for", async () => {
  for (const [wish, expected] of [
    ["auto", "server"],
    ["webgl", "webgl"],
  ] as const) {
    const local = new Fake("webgl", 0);
    local.isSoftware = true;
    assert.equal(await by(chosen(new Fake("server", 0), wish, () => local)), expected);
  }
});

test("the server renders if the address says so, without WebGL, and after its loss or refusal", async () => {
  const fail = (): never => {
    throw new Error("no WebGL");
  };
  const without = chosen(new Fake("server", 0), "auto", fail);
  assert.equal(await by(without), "server");
  assert.equal(without.reason, "no WebGL");
  assert.equal(await by(chosen(new Fake("server", 0), "server", fail)), "server");

  let lose = () => {};
  let news = 0;
  const local = new Fake("webgl", 0);
  const open = (lost: () => void) => {
    lose = lost;
    return local;
  };
  const pictures = chosen(new Fake("server", 0), "webgl", open, () => ++news);
  assert.equal(await by(pictures), "webgl");
  lose();
  assert.equal(news, 1);
  assert.equal(await by(pictures), "server");

  const refusing = new Fake("webgl", 0);
  refusing.fault = "distortion";
  const refused = chosen(new Fake("server", 0), "webgl", () => refusing);
  assert.equal(await by(refused), "server");
  assert.equal(refused.reason, "distortion");
});
