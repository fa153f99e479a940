// SPDX-License-Identifier: Apache-2.0
// Vectors and matrices of single precision for pictures: small enough for every header, and laid out as shaders read
// them.
#pragma once

#include <algorithm>
#include <cmath>

namespace mercury::render {

struct Vector2 {
  float x = 0, y = 0;
  constexpr Vector2() = default;
  constexpr Vector2(float x_, float y_) : x(x_), y(y_) {}
  constexpr float dot(Vector2 b) const { return x * b.x + y * b.y; }
  float norm() const { return std::sqrt(dot(*this)); }
  friend constexpr bool operator==(const Vector2&, const Vector2&) = default;
};
constexpr Vector2 operator+(Vector2 a, Vector2 b) { return {a.x + b.x, a.y + b.y}; }
constexpr Vector2 operator-(Vector2 a, Vector2 b) { return {a.x - b.x, a.y - b.y}; }
constexpr Vector2 operator-(Vector2 a) { return {-a.x, -a.y}; }
constexpr Vector2 operator*(float s, Vector2 a) { return {s * a.x, s * a.y}; }
inline Vector2 smallest(Vector2 a, Vector2 b) { return {std::min(a.x, b.x), std::min(a.y, b.y)}; }
inline Vector2 largest(Vector2 a, Vector2 b) { return {std::max(a.x, b.x), std::max(a.y, b.y)}; }

struct Vector3 {
  float x = 0, y = 0, z = 0;

  constexpr Vector3() = default;
  constexpr Vector3(float x_, float y_, float z_) : x(x_), y(y_), z(z_) {}
  constexpr explicit Vector3(const float* xyz) : x(xyz[0]), y(xyz[1]), z(xyz[2]) {}
  // From another type with three coordinates.
  template <class Other>
  requires requires(const Other& v) { v.x, v.y, v.z; }
  constexpr explicit Vector3(const Other& v) : x(v.x), y(v.y), z(v.z) {}
  static constexpr Vector3 all(float value) { return {value, value, value}; }
  static constexpr Vector3 unit(int axis) { return {float(axis == 0), float(axis == 1), float(axis == 2)}; }

  constexpr float& operator[](int axis) { return axis == 0 ? x : axis == 1 ? y : z; }
  constexpr float operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
  const float* data() const { return &x; }

  constexpr float dot(const Vector3& b) const { return x * b.x + y * b.y + z * b.z; }
  constexpr Vector3 cross(const Vector3& b) const { return {y * b.z - z * b.y, z * b.x - x * b.z, x * b.y - y * b.x}; }
  float norm() const { return std::sqrt(dot(*this)); }
  constexpr float squared_norm() const { return dot(*this); }
  // Without length, it stays as it is.
  Vector3 normalized() const;
  Vector3 absolute() const { return {std::fabs(x), std::fabs(y), std::fabs(z)}; }
  bool is_finite() const { return std::isfinite(x) && std::isfinite(y) && std::isfinite(z); }
  constexpr Vector2 xy() const { return {x, y}; }

  constexpr Vector3& operator+=(const Vector3& b) { return *this = {x + b.x, y + b.y, z + b.z}; }
  constexpr Vector3& operator-=(const Vector3& b) { return *this = {x - b.x, y - b.y, z - b.z}; }
  constexpr Vector3& operator*=(float s) { return *this = {s * x, s * y, s * z}; }
  friend constexpr bool operator==(const Vector3&, const Vector3&) = default;
};
constexpr Vector3 operator+(Vector3 a, const Vector3& b) { return a += b; }
constexpr Vector3 operator-(Vector3 a, const Vector3& b) { return a -= b; }
constexpr Vector3 operator-(const Vector3& a) { return {-a.x, -a.y, -a.z}; }
constexpr Vector3 operator*(float s, Vector3 a) { return a *= s; }
constexpr Vector3 operator*(Vector3 a, float s) { return a *= s; }
constexpr Vector3 operator/(const Vector3& a, float s) { return {a.x / s, a.y / s, a.z / s}; }

inline Vector3 Vector3::normalized() const {
  const float length = norm();
  return length > 0 ? *this / length : *this;
}
inline Vector3 smallest(const Vector3& a, const Vector3& b) {
  return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
inline Vector3 largest(const Vector3& a, const Vector3& b) {
  return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}

struct Vector4 {
  float x = 0, y = 0, z = 0, w = 0;
  constexpr Vector4() = default;
  constexpr Vector4(float x_, float y_, float z_, float w_) : x(x_), y(y_), z(z_), w(w_) {}
  constexpr Vector4(const Vector3& v, float w_) : x(v.x), y(v.y), z(v.z), w(w_) {}
  constexpr Vector3 xyz() const { return {x, y, z}; }
  const float* data() const { return &x; }
  friend constexpr bool operator==(const Vector4&, const Vector4&) = default;
};

// 4 x 4 numbers, column after column.
struct Matrix4 {
  float values[16] = {};

  static constexpr Matrix4 identity() {
    Matrix4 m;
    for (int i = 0; i < 4; ++i) m(i, i) = 1;
    return m;
  }
  constexpr float& operator()(int row, int column) { return values[4 * column + row]; }
  constexpr float operator()(int row, int column) const { return values[4 * column + row]; }
  constexpr void set_row(int row, const Vector3& v) {
    for (int column = 0; column < 3; ++column) (*this)(row, column) = v[column];
  }
  constexpr Vector3 column(int i) const { return {(*this)(0, i), (*this)(1, i), (*this)(2, i)}; }
  const float* data() const { return values; }
  friend constexpr bool operator==(const Matrix4&, const Matrix4&) = default;
};
constexpr Vector4 operator*(const Matrix4& m, const Vector4& v) {
  const auto row = [&](int i) { return m(i, 0) * v.x + m(i, 1) * v.y + m(i, 2) * v.z + m(i, 3) * v.w; };
  return {row(0), row(1), row(2), row(3)};
}
constexpr Matrix4 operator*(const Matrix4& a, const Matrix4& b) {
  Matrix4 product;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      for (int i = 0; i < 4; ++i) product(row, column) += a(row, i) * b(i, column);
  return product;
}
// Of a matrix that has one.
Matrix4 inverse(const Matrix4& m);

}  // namespace mercury::render
