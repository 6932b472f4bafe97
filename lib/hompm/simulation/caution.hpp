// What a scene asks for that is known to go wrong in the end.
#pragma once

#include <string>

#include <hompm/scene/scene.hpp>

namespace hompm {

/// One sentence: what goes wrong, why, and what to take instead; "" where nothing is known. A scene it
/// speaks of can be run all the same. So far: update stress last with hat functions at a moving free end
/// (Sulsky, Zhou, Schreyer, Comput. Phys. Commun. 87 (1995) 236–252; Bardenhagen, J. Comput. Phys. 180
/// (2002) 383–403).
std::string caution(const Scene& scene);

}  // namespace hompm
