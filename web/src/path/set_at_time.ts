// SPDX-License-Identifier: Apache-2.0
// Sets quantities at the time of a frame, as a person means it who looks at this frame: a quantity with keys gets a key
// there, any other the value for the whole film. If PathDocument.addsKeys is true, every quantity gets a key.

import { setEasedKey } from "./eases";
import type { PathDocument } from "./path_document";
import type { PathValue } from "./path_quantities";

// If the quantity has keys, sets the key at `time` or adds one; otherwise sets its value for the whole film, and
// removes a motion by speed or accelerations. If document.addsKeys is true, always sets or adds a key.
export function setAtTime(document: PathDocument, name: string, time: number, value: PathValue): void {
  const { keyframes, hasAccelerations } = document.quantity(name);
  if (hasAccelerations) document.removeMotion(name, value);
  if (keyframes.length > 0 || document.addsKeys) setEasedKey(document, name, time, value);
  else if (!hasAccelerations) document.setBase(name, value);
}

// Sets the focus distance. If the file defines the focus in another way, or by speed or accelerations, replaces this
// definition and returns a text that says so; otherwise returns "".
export function setFocusDistance(document: PathDocument, time: number, distance: number): string {
  const { given, hasAccelerations } = document.quantity("focus_distance");
  if (!given) document.useFocusDistance(distance);
  if (given || document.addsKeys) setAtTime(document, "focus_distance", time, distance);
  return given && !hasAccelerations ? "" : ", which replaces the previous definition of the focus";
}
