// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { mock, test } from "node:test";

import { LiveRequests, PAUSE_MS } from "../../src/live/live_requests";

// Requests that the test answers one by one.
function recorder() {
  const asked: { isStill: boolean; isNewest: () => boolean; answer: (isThere?: boolean) => Promise<void> }[] = [];
  const requests = new LiveRequests((isStill, isNewest) => {
    return new Promise((resolve) => {
      // Waits until the requests that follow from the answer have been made.
      const answer = async (isThere = true): Promise<void> => {
        resolve(isThere);
        for (let i = 0; i < 5; ++i) await Promise.resolve();
      };
      asked.push({ isStill, isNewest, answer });
    });
  });
  return { asked, requests };
}

// Runs a test with a clock that stands still unless the test moves it.
const clock = { now: 0, timers: new Map<number, { at: number; run: () => void }>(), count: 0 };

function tick(time: number): void {
  const end = clock.now + time;
  for (;;) {
    const due = [...clock.timers].filter(([, timer]) => timer.at <= end).sort((a, b) => a[1].at - b[1].at)[0];
    if (!due) break;
    clock.timers.delete(due[0]);
    clock.now = due[1].at;
    due[1].run();
  }
  clock.now = end;
}

function withClock(body: () => Promise<void>): () => Promise<void> {
  return async () => {
    clock.timers.clear();
    mock.method(performance, "now", () => clock.now);
    mock.method(globalThis, "setTimeout", (run: () => void, time: number) => {
      clock.timers.set(++clock.count, { at: clock.now + time, run });
      return clock.count;
    });
    mock.method(globalThis, "clearTimeout", (timer: number) => clock.timers.delete(timer));
    try {
      await body();
    } finally {
      mock.restoreAll();
    }
  };
}

test(
  "quick pictures follow each other, and a still picture ends them",
  withClock(async () => {
    const { asked, requests } = recorder();
    requests.start();
    assert.equal(asked.length, 1);
    for (let i = 0; i < 10; ++i) requests.change();
    assert.equal(asked.length, 1, "one request at a time");
    await asked[0].answer();
    assert.equal(asked.length, 2, "the newest state, once");
    await asked[1].answer();
    tick(PAUSE_MS - 1);
    assert.equal(asked.length, 2);
    tick(1);
    assert.deepEqual(
      asked.map((one) => one.isStill),
      [false, false, true],
    );
    await asked[2].answer();
    tick(60_000);
    assert.equal(asked.length, 3);
  }),
);

test(
  "a change does not wait for a still picture, which is then not shown",
  withClock(async () => {
    const { asked, requests } = recorder();
    requests.start();
    await asked[0].answer();
    tick(PAUSE_MS);
    assert.ok(asked[1].isStill && asked[1].isNewest());
    requests.change();
    assert.equal(asked.length, 3);
    assert.ok(!asked[2].isStill && asked[2].isNewest());
    assert.ok(!asked[1].isNewest());
    await asked[2].answer();
    tick(PAUSE_MS);
    assert.equal(asked.length, 3, "the old still picture is on the way");
    await asked[1].answer();
    tick(60_000);
    assert.equal(asked.length, 4);
    assert.ok(asked[3].isStill);
  }),
);

test(
  "loaded LF images are asked for by still pictures, and by the last",
  withClock(async () => {
    const { asked, requests } = recorder();
    requests.start();
    await asked[0].answer();
    tick(PAUSE_MS);
    await asked[1].answer();
    for (let i = 0; i < 5; ++i) requests.loaded();
    tick(60_000);
    assert.equal(asked.length, 3);
    requests.loaded(); // while the picture is made
    tick(60_000);
    assert.equal(asked.length, 3);
    await asked[2].answer();
    tick(60_000);
    assert.equal(asked.length, 4);
    assert.ok(asked[3].isStill);
  }),
);

test(
  "a stopped view asks for nothing, and shows nothing that comes",
  withClock(async () => {
    const { asked, requests } = recorder();
    requests.change();
    assert.equal(asked.length, 0, "not started yet");
    requests.start();
    requests.stop();
    assert.ok(!asked[0].isNewest());
    await asked[0].answer();
    requests.change();
    requests.loaded();
    tick(60_000);
    assert.equal(asked.length, 1);
    requests.start();
    assert.equal(asked.length, 2);
    assert.ok(asked[1].isNewest());
  }),
);

test(
  "a picture that another page superseded is asked for again, less and less often",
  withClock(async () => {
    const { asked, requests } = recorder();
    requests.start();
    await asked[0].answer();
    tick(PAUSE_MS);
    const pauses: number[] = [];
    for (let i = 1; i < 5; ++i) {
      await asked[i].answer(false);
      const before = clock.now;
      while (asked.length === i + 1) tick(50);
      pauses.push(clock.now - before);
    }
    for (let i = 1; i < pauses.length; ++i) assert.ok(pauses[i] > pauses[i - 1], pauses.join(", "));
    await asked[5].answer();
    tick(60_000);
    assert.equal(asked.length, 6);
  }),
);
