// SPDX-License-Identifier: Apache-2.0
// The round shadow of a ball.
layout(location = 0) in vec2 on_ball;

void main() {
  if (dot(on_ball, on_ball) > 1.0) discard;
}
