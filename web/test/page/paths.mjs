// SPDX-License-Identifier: Apache-2.0
// The camera paths that the tests of the page begin with.
export const SHOP_PATH = `# Through the shop, with a wide triangle.
format: lfpath 1
fps: 24
frames: 49
resolution: [240, 160]
camera:
  focal_length_mm: 30
  position: [-0.06, 0, 0]
  orientation: {yaw: 0}
lens:
  aperture_diameter: 0.56   # of 0.8
  focus_distance: 8.12      # the sign
  blades: 3
keyframes:
  position: [{time: 0, value: [-0.06, 0, 0]}, {time: 2, value: [0.06, 0, 0]}]
  focus_distance: [{time: 0.5, value: 8.12}, {time: 1.5, value: 6.3}]   # to the robot
`;

export const CHART_PATH = `format: lfpath 1
fps: 10
frames: 11
resolution: [96, 64]
camera:
  field_of_view_deg: 50
  position: [0, 0, -1]      # where the middle camera stands
  look_at: [0, 0, 0]
lens:
  aperture_diameter_mm: 12
  focus_distance: 1
keyframes:
  # There and back.
  focus_distance: [{time: 0, value: 1}, {time: 1, value: 1.2}]
`;
