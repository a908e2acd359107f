#pragma once

#include <nlohmann/json.hpp>

namespace meshfarm {

/// JSON whose members keep the order in which they were written.
using Json = nlohmann::ordered_json;

}  // namespace meshfarm
