// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <meshfarm/io/sorting.hpp>

namespace meshfarm {
namespace {

bool get_flag(ByteReader& in) {
  const auto value = in.get<std::uint8_t>();
  if (value > 1) in.fail("impossible sorting");
  return value == 1;
}

}  // namespace

void put(ByteWriter& out, const Sorting& sorting) {
  for (const int axis : sorting.order.axes) out.put(static_cast<std::uint8_t>(axis));
  out.put(static_cast<std::uint8_t>(sorting.order.sign < 0 ? 1 : 0));
  out.put(static_cast<std::uint8_t>(sorting.weld == Weld::off ? 1 : 0));
}

Sorting get_sorting(ByteReader& in) {
  Sorting sorting;
  unsigned seen = 0;
  for (int& axis : sorting.order.axes) {
    axis = in.get<std::uint8_t>();
    if (axis > 2) in.fail("impossible axis");
    seen |= 1U << axis;
  }
  if (seen != 0b111) in.fail("an axis is named twice");
  sorting.order.sign = get_flag(in) ? -1 : 1;
  sorting.weld = get_flag(in) ? Weld::off : Weld::exact;
  return sorting;
}

}  // namespace meshfarm
