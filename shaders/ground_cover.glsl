// SPDX-License-Identifier: Apache-2.0
// What grows and lies on the floor, as ground_cover.comp places it.
struct Item {
  vec3 foot;     // where it stands [m]
  float height;  // of a plant, or of a stone above the floor [m]; 0 = there is none
  float turn;    // about the vertical [rad]
  float phase;   // a number in [0, 1) of its own
  float kind;    // ITEM_...
  float unused;
};
#define ITEM_PLANT 0.0
#define ITEM_STONE 1.0
