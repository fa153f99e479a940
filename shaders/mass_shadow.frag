// SPDX-License-Identifier: Apache-2.0
// A ball's round shadow.
layout(location = 0) in vec2 place;

void main() {
  if (dot(place, place) > 1.0) discard;
}
