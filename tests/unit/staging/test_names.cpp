// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <meshfarm/staging/names.hpp>

using namespace meshfarm;

TEST_CASE("every name that is made is parsed back") {
  for (const StagedName& name :
       {StagedName(ManifestName{}), StagedName(BoundaryName{}), StagedName(PartName{0}),
        StagedName(PartName{4'294'967'295U}), StagedName(JournalName{12}),
        StagedName(EndpointName{1'000'000}), StagedName(TraceName{3}), StagedName(SummaryName{4}),
        StagedName(KeysName{0xfedcba9876543210ULL}), StagedName(HostName{0xfedcba9876543210ULL}),
        StagedName(StreamName{7}), StagedName(SlabName{8}), StagedName(PictureName{9}),
        StagedName(ResultName{0xfedcba9876543210ULL, 3, 0x0123456789abcdefULL})}) {
    const auto parsed = parse_staged_name(to_string(name));
    REQUIRE(parsed.has_value());
    CHECK(parsed->index() == name.index());
    CHECK(to_string(*parsed) == to_string(name));
  }
  CHECK(to_string(KeysName{10}) == "control/000000000000000a.keys");
  CHECK(to_string(SlabName{123}) == "streams/000123.slab");
  CHECK(to_string(PartName{123}) == "parts/000123.part");
  CHECK(to_string(PictureName{123}) == "parts/000123.picture");
  CHECK(to_string(ResultName{1, 2, 3}) == "results/0000000000000001.a2.0000000000000003");
}

TEST_CASE("any other text is no staged name") {
  for (const char* text : {"",
                           "/",
                           "..",
                           "parts",
                           "parts/",
                           "parts/1.part",
                           "parts/000001.part/",
                           "parts/1.picture",
                           "parts/000001.pictures",
                           "streams/1.slab",
                           "streams/000001.slabs",
                           "parts/000001.parts",
                           "parts/-00001.part",
                           "parts/+00001.part",
                           "parts/99999999999.part",
                           "/parts/000001.part",
                           "./parts/000001.part",
                           "parts/../manifest",
                           "results/1.a1.1",
                           "results/x.a1.y",
                           "Manifest",
                           "manifest ",
                           "control/000001",
                           "control/000001.keys",
                           "control/000000000000000A.keys",
                           "control/000000000000000a.endpoint",
                           "journal/000001.endpoint",
                           "log/000001",
                           "log/000001.log",
                           "log/.trace",
                           "results/FEDCBA9876543210.a1.0000000000000001",
                           "../../etc/passwd"}) {
    CAPTURE(text);
    CHECK_FALSE(parse_staged_name(text).has_value());
  }
  CHECK_FALSE(parse_staged_name(std::string_view("manifest\0", 9)).has_value());
}
