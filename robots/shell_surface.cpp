// SPDX-License-Identifier: Apache-2.0
#include "robots/shell_surface.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "robots/portable_math.h"

namespace mercury {

double once_around(const ShellGenome& genome, double count) {
  return genome.form == ShellForm::ring ? std::round(count) : count;
}

double lobe_wave(const ShellGenome& genome, double s, double turns) {
  return wave(genome.lobes * turns + once_around(genome, genome.twist * genome.lobes) * s).cosine;
}

namespace {

// The surface of a shell, in units of half the diameter.
class Surface {
 public:
  explicit Surface(const ShellGenome& genome) : g_(genome) {
    for (int i = 0; i <= samples; ++i) widest_ = std::max(widest_, raw_profile(fraction(i)).r);
  }

  using Profile = RevolvedSurface::Profile;
  Profile profile(double s) const {
    const Profile raw = raw_profile(s);
    return {raw.r / widest_, raw.z / widest_};
  }
  Point at(double s, double turns) const {
    const Profile p = profile(s);
    const double lobe = lobe_wave(g_, s, turns);
    const double r = p.r * (1 + g_.lobe_depth * lobe_weight(s) * lobe);
    const double hang = is_bell() ? s * s * s * s : is_tube() ? (2 * s - 1) * (2 * s - 1) * (2 * s - 1) : 0;
    const auto [sine, cosine] = wave(turns);
    return {r * cosine, r * sine, p.z - g_.lappets * hang * lobe};
  }

 private:
  static constexpr int samples = 512;
  static double fraction(int i) { return static_cast<double>(i) / samples; }
  bool is_bell() const { return g_.form == ShellForm::bell; }
  bool is_tube() const { return g_.form == ShellForm::tube; }

  // Lobes grow from a pole, where the surface must stay smooth.
  double lobe_weight(double s) const {
    if (is_bell()) return s * s * (3 - 2 * s);
    if (g_.form == ShellForm::pod) return 16 * s * s * (1 - s) * (1 - s);
    return 1;
  }

  Profile raw_profile(double s) const {
    switch (g_.form) {
      case ShellForm::bell: {
        const double angle = (0.44 - 0.2 * g_.opening) * s;
        const auto [sine, cosine] = wave(angle);
        const double s2 = s * s;
        return {sine + g_.squareness * wave(3 * angle).sine + g_.flare * s2 * s2 * s2, g_.height * cosine};
      }
      case ShellForm::tube: {
        const double end = 0.35 + 0.6 * g_.opening, middle = wave(s / 2).sine, from_middle = 2 * s - 1;
        return {end + (1 - end) * middle + g_.squareness * wave(1.5 * s).sine +
                    g_.flare * from_middle * from_middle * from_middle * from_middle,
                -g_.height * from_middle};
      }
      case ShellForm::ring: {
        const double tube = 0.42 - 0.22 * g_.opening;
        const auto [sine, cosine] = wave(s);
        return {1 - tube + tube * cosine, -tube * (0.5 + g_.height) * sine};
      }
      case ShellForm::pod:
        break;
    }
    const double angle = s / 2;
    return {wave(angle).sine + g_.squareness * wave(3 * angle).sine, g_.height * wave(angle).cosine};
  }

  const ShellGenome& g_;
  double widest_ = 0;
};

}  // namespace

RevolvedMesh mesh_of(const ShellGenome& genome) {
  const Surface surface(genome);
  const bool is_pod = genome.form == ShellForm::pod;
  return RevolvedMesh({.profile = [&](double s) { return surface.profile(s); },
                       .point = [&](double s, double turns) { return surface.at(s, turns); },
                       .lobes = genome.lobes,
                       .closed = genome.form == ShellForm::ring,
                       .starts_on_axis = is_pod || genome.form == ShellForm::bell,
                       .ends_on_axis = is_pod},
                      2 * std::numbers::pi / genome.segments);
}

}  // namespace mercury
