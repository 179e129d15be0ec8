// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { History } from "../../src/path/history";

test("edits are undone and redone in turn", () => {
  const history = new History("a");
  assert.equal(history.undo(), undefined);
  history.push("b", "move");
  history.push("c", "delete");
  assert.deepEqual(history.labels, ["move", "delete"]);
  assert.equal(history.undoLabel, "delete");
  assert.equal(history.undo(), "b");
  assert.equal(history.redoLabel, "delete");
  assert.equal(history.undo(), "a");
  assert.equal(history.canUndo, false);
  assert.equal(history.redo(), "b");
  history.push("d", "other");
  assert.equal(history.canRedo, false);
  assert.equal(history.redo(), undefined);
  assert.deepEqual([history.text, history.done, history.labels], ["d", 2, ["move", "other"]]);
});

test("the edits of a drag are one", () => {
  const history = new History("a");
  for (const text of ["b", "c", "d"]) history.push(text, "move", { merge: true });
  assert.equal(history.labels.length, 1);
  history.seal();
  history.push("e", "move", { merge: true });
  history.push("f", "turn", { merge: true });
  history.push("g", "turn");
  history.push("h", "turn", { merge: true });
  assert.deepEqual(history.labels, ["move", "move", "turn", "turn", "turn"]);
  history.undo();
  history.push("i", "turn", { merge: true });
  assert.deepEqual(history.labels, ["move", "move", "turn", "turn", "turn"]);
  assert.equal(history.undo(), "g");
});

test("the same text is no edit", () => {
  const history = new History("a");
  history.push("b", "move");
  history.undo();
  history.push("a", "move");
  assert.equal(history.canRedo, true);
});

test("old edits are forgotten", () => {
  const history = new History("0");
  for (let i = 1; i <= 300; ++i) history.push(`${i}`, `edit ${i}`);
  assert.equal(history.labels.length, 200);
  while (history.canUndo) history.undo();
  assert.equal(history.text, "100");
});
