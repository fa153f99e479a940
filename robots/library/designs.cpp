#include "robots/library/designs.h"

namespace mercury::library {

std::vector<Robot> all_designs() {
  return {eel(),    fish(),     ray(),       manta(),  jellyfish(), squid(), turtle(),
          sea_star(), quadruped(), beetle(), inchworm(), caterpillar(), hopper()};
}

}  // namespace mercury::library
