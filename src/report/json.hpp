#pragma once

#include <nlohmann/json.hpp>

namespace meshfarm {

/// JSON whose members stay in the order in which they were written.
using Json = nlohmann::ordered_json;

}  // namespace meshfarm
