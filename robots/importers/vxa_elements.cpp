// SPDX-License-Identifier: Apache-2.0
// Elements of VXA files that are known and not used. They are those that VoxCAD, evosoro and voxcraft-sim read or
// write.
#include <algorithm>
#include <array>
#include <string_view>

#include "robots/importers/vxa_reader.h"

namespace mercury {
namespace {

struct KnownElement {
  std::string_view part;    // of the place, between slashes
  std::string_view reason;  // why it is ignored
};

constexpr std::string_view not_fixed = "of a region; only where regions hold voxels along all axes is kept";
constexpr std::string_view no_growth = "robots of Mercury do not grow or develop";
constexpr std::string_view no_brain = "a controller of evosoro; muscles follow their sine";
constexpr std::string_view no_signals = "electrical signals have no counterpart";
constexpr std::string_view no_cilia = "cilia have no counterpart";
constexpr std::string_view no_failure = "springs of Mercury are linear and do not yield or break";
constexpr std::string_view own_step = "the time step of the configuration follows from the stiffest spring";
constexpr std::string_view own_run = "of a run and its results, not of the robot";
constexpr std::string_view no_bodies = "bodies do not stick to each other";

constexpr auto known = std::to_array<KnownElement>({
    {"Integration", own_step},
    {"ColDampingZ", "contacts of Mercury have no damping of their own"},
    {"ColSystem", "Mercury's own search for contacts"},
    {"CollisionHorizon", "Mercury's own search for contacts"},
    {"SelfColEnabled", "self-collision on land"},
    {"FluidDampEnabled", "its programs ignore it"},
    {"EnforceLatticeEnabled", "its programs ignore it"},
    {"PoissonKickBackEnabled", "its programs ignore it"},
    {"VolumeEffectsEnabled", "the lattice of springs has a Poisson ratio of its own, about 0.35"},
    {"MaxVelLimitEnabled", "velocities are not limited"},
    {"MaxVoxVelLimit", "velocities are not limited"},
    {"BlendingEnabled", "materials are not blended"},
    {"MixRadius", "materials are not blended"},
    {"XMixRadius", "materials are not blended"},
    {"YMixRadius", "materials are not blended"},
    {"ZMixRadius", "materials are not blended"},
    {"BlendModel", "materials are not blended"},
    {"PolyExp", "materials are not blended"},
    {"StopCondition", own_run},
    {"SimStop", own_run},
    {"EquilibriumMode", own_run},
    {"SurfMesh", "a mesh for drawing; the skin is made of the voxels' sides"},
    {"GA", own_run},
    {"RecordHistory", own_run},
    {"FitnessFunction", own_run},
    {"SavePositionOfAllVoxels", own_run},
    {"MaxDistInVoxelLengthsToCountAsPair", own_run},
    {"EnableTargetCloseness", own_run},
    {"SecondaryExperiment", own_run},
    {"ReinitializeInitialPositionAfterThisManySeconds", own_run},
    {"ErrorThreshold", own_run},
    {"ThresholdTime", own_run},
    {"ParentLifetime", own_run},
    {"MinTempFact", own_step},
    {"MaxTempFactChange", no_growth},
    {"MaxStiffnessChange", no_growth},
    {"MinElasticMod", "a limit of evosoro's search"},
    {"MaxElasticMod", "a limit of evosoro's search"},
    {"MaxKP", no_brain},
    {"MaxKI", no_brain},
    {"MaxANTIWINDUP", no_brain},
    {"AttachDetach", no_bodies},
    {"ForceField", "there is no force field; gravity and flow of water are uniform"},
    {"EnableCilia", no_cilia},
    {"EnableSignals", no_signals},
    {"GPU", own_run},
    {"RawPrint", own_run},
    {"Fixed_Regions", not_fixed},
    {"Forced_Regions", not_fixed},
    {"Boundary_Conditions", not_fixed},
    {"FloorSlope", "its programs ignore it"},
    {"NeuralNet", no_brain},
    {"MinGrowthTime", no_growth},
    {"GrowthModel", no_growth},
    {"NormDistByVol", own_run},
    {"SaveTraces", own_run},
    {"TimeBetweenTraces", own_run},
    {"StickyFloor", "the floor has friction alone"},
    {"FallingProhibited", own_run},
    {"OnsetRelative", no_growth},
    {"TerminationRelative", no_growth},
    {"NormalizationExponent", own_run},
    {"BallisticSlowdownFact", no_growth},
    {"MaxSlowdownPermitted", no_growth},
    {"NumTimeStepsInWindow", no_growth},
    {"NeedleInHaystack", own_run},
    {"FloorRadius", "the floor has no end"},
    {"Sources", "light, sound and other sources have no counterpart"},
    {"Voxel", "voxels of Mercury are cubes"},
    {"MatType", "all materials are single ones"},
    {"Display", "Mercury colors materials by what they do"},
    {"MatModel", no_failure},
    {"SSData", no_failure},
    {"Plastic_Mod", no_failure},
    {"Yield_Stress", no_failure},
    {"FailModel", no_failure},
    {"Fail_Stress", no_failure},
    {"Fail_Strain", no_failure},
    {"Poissons_Ratio", "the lattice of springs has a Poisson ratio of its own, about 0.35"},
    {"Fixed", not_fixed},
    {"Sticky", no_bodies},
    {"Cilia", no_cilia},
    {"isPaceMaker", no_signals},
    {"IsPacemaker", no_signals},
    {"IsConductive", no_signals},
    {"PaceMakerPeriod", no_signals},
    {"signalValueDecay", no_signals},
    {"signalTimeDelay", no_signals},
    {"inactivePeriod", no_signals},
    {"isElectricalActive", no_signals},
    {"isMeasured", own_run},
    {"isTarget", own_run},
    {"RemoveFromSimulationAfterThisManySeconds", "voxels are not removed in a run"},
    {"TurnOnThermalExpansionAfterThisManySeconds", "muscles move from the start"},
    {"TurnOnCiliaAfterThisManySeconds", no_cilia},
    {"BaseCiliaForce", no_cilia},
    {"ShiftCiliaForce", no_cilia},
    {"FinalPhaseOffset", no_growth},
    {"FinalTempAmpDamp", no_growth},
    {"FinalVoxelSize", no_growth},
    {"GrowthTime", no_growth},
    {"StartGrowthTime", no_growth},
    {"StiffnessPlasticityRate", no_growth},
    {"KP", no_brain},
    {"KI", no_brain},
    {"ANTIWINDUP", no_brain},
});

bool contains(std::string_view place, std::string_view part) {
  for (std::size_t begin = 1; begin < place.size();) {
    const std::size_t end = std::min(place.find('/', begin), place.size());
    std::string_view word = place.substr(begin, end - begin);
    word = word.substr(0, word.find('['));
    if (word == part) return true;
    begin = end + 1;
  }
  return false;
}

}  // namespace

std::string_view known_vxa_element(std::string_view place) {
  for (const KnownElement& element : known)
    if (contains(place, element.part)) return element.reason;
  return {};
}

}  // namespace mercury
