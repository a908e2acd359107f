// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>

#include <doctest/doctest.h>
#include <meshoptimizer.h>
#include <nlohmann/json.hpp>
#include <support/meshes.hpp>

#include <meshfarm/io/mesh_format.hpp>

#include "gltf_test_files.hpp"
#include "picture_files.hpp"
#include "textured_meshes.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

namespace {

using Json = nlohmann::json;

/// A document and the bytes of its first buffer.
struct Gltf {
  Json json;
  std::string binary;

  explicit Gltf(const std::filesystem::path& path) {
    const std::string bytes = read_file(path);
    if (!bytes.starts_with("glTF")) {
      json = Json::parse(bytes);
      binary = read_file(std::filesystem::path(path).replace_extension(".bin"));
      return;
    }
    std::array<std::uint32_t, 5> head{};
    std::memcpy(head.data(), bytes.data(), sizeof head);
    CHECK(head[2] == bytes.size());
    json = Json::parse(bytes.substr(20, head[3]));
    binary = bytes.substr(28 + head[3]);
    CHECK(binary.size() % 4 == 0);
    CHECK(binary.size() - json["buffers"][0]["byteLength"].get<std::size_t>() < 4);
  }

  std::string view(std::size_t number) const {
    const Json& whole = json["bufferViews"][number];
    if (!whole.contains("extensions")) {
      return binary.substr(whole.value("byteOffset", 0U), whole["byteLength"]);
    }
    const Json& packed = whole["extensions"]["EXT_meshopt_compression"];
    const std::size_t count = packed["count"];
    const std::size_t stride = packed["byteStride"];
    const auto* from = reinterpret_cast<const unsigned char*>(binary.data()) +
                       packed["byteOffset"].get<std::size_t>();
    std::string made(count * stride, '\0');
    const bool is_vertices = packed["mode"] == "ATTRIBUTES";
    CHECK((is_vertices
               ? meshopt_decodeVertexBuffer(made.data(), count, stride, from, packed["byteLength"])
               : meshopt_decodeIndexBuffer(made.data(), count, stride, from,
                                           packed["byteLength"])) == 0);
    return made;
  }

  template <class T>
  T at(const std::string& bytes, const Json& accessor, std::size_t row, std::size_t stride) const {
    T made{};
    const std::size_t first = accessor.value("byteOffset", std::size_t{0}) + row * stride;
    REQUIRE(first + sizeof(T) <= bytes.size());
    std::memcpy(&made, bytes.data() + first, sizeof made);
    return made;
  }

  /// The texture coordinates of all triangles' corners, primitive by primitive.
  std::vector<CornerUvs> uvs() const {
    std::vector<CornerUvs> made;
    for (const Json& primitive : json["meshes"][0]["primitives"]) {
      const Json& indices = json["accessors"][primitive["indices"].get<std::size_t>()];
      const Json& uvs = json["accessors"][primitive["attributes"]["TEXCOORD_0"].get<std::size_t>()];
      const std::string index_bytes = view(indices["bufferView"]);
      const std::string uv_bytes = view(uvs["bufferView"]);
      const std::size_t stride =
          json["bufferViews"][uvs["bufferView"].get<std::size_t>()]["byteStride"];
      for (std::size_t i = 0; i < indices["count"]; ++i) {
        const std::size_t vertex = indices["componentType"] == 5123
                                       ? at<std::uint16_t>(index_bytes, indices, i, 2)
                                       : at<std::uint32_t>(index_bytes, indices, i, 4);
        Uv uv{};
        if (uvs["componentType"] == 5126) {
          uv = at<Uv>(uv_bytes, uvs, vertex, stride);
        } else {
          const auto whole = at<std::array<std::uint16_t, 2>>(uv_bytes, uvs, vertex, stride);
          uv = {static_cast<float>(whole[0]) / 65535, static_cast<float>(whole[1]) / 65535};
        }
        if (i % 3 == 0) made.emplace_back();
        made.back()[i % 3] = {uv[0], 1 - uv[1]};
      }
    }
    return made;
  }
};

/// The greatest difference, independent of which corner of a triangle comes first.
float greatest_textured_move(const std::vector<CornerUvs>& a, const std::vector<CornerUvs>& b) {
  REQUIRE(a.size() == b.size());
  float greatest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    float least = HUGE_VALF;
    for (std::size_t turn = 0; turn < 3; ++turn) {
      float move = 0;
      for (std::size_t k = 0; k < 6; ++k) {
        move = std::max(move, std::abs(a[i][(k / 2 + turn) % 3][k % 2] - b[i][k / 2][k % 2]));
      }
      least = std::min(least, move);
    }
    greatest = std::max(greatest, least);
  }
  return greatest;
}

/// The options with real pictures.
MeshSinkOptions shown_options() {
  MeshSinkOptions options = square_options();
  options.pictures.names = {"maps/atlas.png", "bumps.jpg", "a b.png", "rough.png"};
  options.pictures.load = [](std::size_t picture) {
    const Picture made = gradient(static_cast<std::uint32_t>(picture + 2));
    return picture == 1 ? jpeg_of(made) : png_of(made);
  };
  return options;
}

const char* const k_square_materials =
    R"([{"name":"front","pbrMetallicRoughness":{"baseColorTexture":{"index":0},)"
    R"("metallicRoughnessTexture":{"index":2}},"normalTexture":{"index":1}},)"
    R"({"name":"back","pbrMetallicRoughness":{"baseColorFactor":[1.0,1.0,1.0,0.5],)"
    R"("baseColorTexture":{"index":3},"metallicFactor":0},"occlusionTexture":{"index":4},)"
    R"("emissiveTexture":{"index":5},"emissiveFactor":[1,1,1],"alphaMode":"BLEND"}])";

void check_square(const Gltf& gltf) {
  CHECK(gltf.json["materials"] == Json::parse(k_square_materials));
  CHECK(gltf.json["samplers"] ==
        Json::parse(R"([{"wrapS":10497,"wrapT":10497},{"wrapS":33071,"wrapT":33071}])"));
  CHECK(gltf.json["textures"] ==
        Json::parse(R"([{"sampler":0,"source":0},{"sampler":0,"source":1},)"
                    R"({"sampler":0,"source":2},{"sampler":1,"source":3},)"
                    R"({"sampler":1,"source":2},{"sampler":1,"source":0}])"));
}

}  // namespace

TEST_CASE("a GLB has texture coordinates, and images in it") {
  const TempFolder folder;
  for (const Packing packing : {Packing::plain, Packing::compressed}) {
    MeshSinkOptions options = shown_options();
    options.packing = packing;
    write_textured(folder / "m.glb", textured_square(), options);
    const Gltf gltf(folder / "m.glb");
    check_square(gltf);
    CHECK(greatest_textured_move(gltf.uvs(), textured_square().columns.uvs) < 1.0F / 100'000);
    const Json& images = gltf.json["images"];
    REQUIRE(images.size() == 4);
    const std::array<std::size_t, 4> order{0, 1, 3, 2};  // in the order of their first use
    for (std::size_t i = 0; i < 4; ++i) {
      CHECK(images[i]["mimeType"] == (i == 1 ? "image/jpeg" : "image/png"));
      CHECK((gltf.view(images[i]["bufferView"]) == options.pictures.load(order[i])));
    }
    CHECK(files_in(folder) == 1);
    const std::string bytes = read_file(folder / "m.glb");
    write_textured(folder / "m.glb", textured_square(), options);
    CHECK((read_file(folder / "m.glb") == bytes));
  }
}

TEST_CASE("a vertex of a GLB is split where it has several texture coordinates") {
  const TempFolder folder;
  write_textured(folder / "m.glb", textured_square(), shown_options());
  const Gltf gltf(folder / "m.glb");
  const std::string vertices = raw<float>({0, 0, 0,    0,      1,             // v goes downwards
                                           1, 0, 0,    0.5F,   1,             //
                                           0, 1, 0,    0,      0,             //
                                           1, 1, 0.5F, 1,      1 - 1.0F / 3,  //
                                           1, 0, 0,    0.625F, 0});
  CHECK(gltf.view(0) == vertices);
  CHECK(gltf.view(1) == raw<std::uint16_t>({0, 1, 2, 2, 4, 3}));
  CHECK(gltf.json["accessors"][0]["count"] == 5);
  CHECK(read_path(folder / "m.glb").mesh.positions.size() == 5);
}

TEST_CASE("a glTF has pictures beside it") {
  const TempFolder folder;
  write_textured(folder / "my m.gltf", textured_square(), shown_options());
  const Gltf gltf(folder / "my m.gltf");
  check_square(gltf);
  CHECK(greatest_textured_move(gltf.uvs(), textured_square().columns.uvs) < 1e-7F);
  CHECK(gltf.json["images"] == Json::parse(R"([{"uri":"my_m_atlas.png"},{"uri":"my_m_bumps.jpg"},)"
                                           R"({"uri":"my_m_rough.png"},{"uri":"my_m_a_b.png"}])"));
  CHECK(files_in(folder) == 6);
  CHECK((read_file(folder / "my_m_a_b.png") == shown_options().pictures.load(2)));
}

TEST_CASE("texture coordinates come without materials, and with channels") {
  const TempFolder folder;
  Mesh mesh = textured_grid(300, 300);  // needs indices of 32 bits
  const std::vector<Channel> channels{{"nx", ChannelType::float32, ChannelRole::normal},
                                      {"ny", ChannelType::float32, ChannelRole::normal},
                                      {"nz", ChannelType::float32, ChannelRole::normal},
                                      {"red", ChannelType::uint8, ChannelRole::colour},
                                      {"green", ChannelType::uint8, ChannelRole::colour},
                                      {"blue", ChannelType::uint8, ChannelRole::colour}};
  std::vector<float> values;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    values.insert(values.end(), {0, 0, 1, static_cast<float>(i % 256), 7, 9});
  }
  for (Vec3& p : mesh.positions) p = p + Vec3{1e6, 0.25, 0};
  for (const char* name : {"m.glb", "m.gltf"}) {
    write_mesh(folder / name, mesh, PositionType::float64, channels, values);
    const Gltf gltf(folder / name);
    CHECK(greatest_textured_move(gltf.uvs(), mesh.columns.uvs) < 1e-6F);
    const ReadFile read = read_path(folder / name);
    CHECK(read.mesh.positions == mesh.positions);
    CHECK(read.mesh.triangles == mesh.triangles);
    CHECK(read.info.channels == channels);
    CHECK_FALSE(gltf.json.contains("images"));
  }
  const std::size_t plain = read_file(folder / "m.glb").size();
  write_mesh(MeshOutput{folder / "m.glb", Packing::compressed}, mesh, PositionType::float64,
             channels, values);
  const Gltf gltf(folder / "m.glb");
  CHECK(greatest_textured_move(gltf.uvs(), mesh.columns.uvs) < 1.01F / 131'070);
  CHECK(read_path(folder / "m.glb").mesh.positions == mesh.positions);
  CHECK(read_path(folder / "m.glb").info.channels == channels);
  CHECK(read_file(folder / "m.glb").size() < plain / 3);
}

TEST_CASE("texture coordinates of a compressed GLB are floats where 16 bits do not do") {
  const TempFolder folder;
  for (const bool is_wide : {false, true}) {
    Mesh mesh = textured_square();
    if (is_wide) mesh.columns.uvs[0][0] = {0, -0.25F};
    MeshSinkOptions options = shown_options();
    options.packing = Packing::compressed;
    write_textured(folder / "m.glb", mesh, options);
    const Gltf gltf(folder / "m.glb");
    CHECK(gltf.json["accessors"][1]["componentType"] == (is_wide ? 5126 : 5123));
    CHECK(gltf.json["accessors"][1].contains("normalized") != is_wide);
    CHECK(greatest_textured_move(gltf.uvs(), mesh.columns.uvs) < (is_wide ? 1e-6F : 1e-5F));
  }
}

TEST_CASE("a GLB with labels is compressed, and material by material") {
  const TempFolder folder;
  Mesh mesh = torus(60, 90);
  for (Vec3& p : mesh.positions) p = rounded(p, PositionType::float32);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    mesh.columns.labels.push_back(static_cast<Label>(i / 10 % 3));
  }
  write_mesh(folder / "plain.glb", mesh, PositionType::float32);
  write_mesh(MeshOutput{folder / "m.glb", Packing::compressed}, mesh, PositionType::float32);
  CHECK(read_file(folder / "m.glb").size() < read_file(folder / "plain.glb").size() / 2);
  const ReadFile plain = read_path(folder / "plain.glb");
  const ReadFile read = read_path(folder / "m.glb");
  CHECK(read.info.labels == plain.info.labels);
  CHECK(read.mesh.columns.labels == plain.mesh.columns.labels);
  REQUIRE(read.mesh.triangles.size() == plain.mesh.triangles.size());
  for (std::size_t i = 0; i < read.mesh.triangles.size(); ++i) {
    Triangle turned = plain.mesh.triangles[i];
    const auto first = std::find(turned.begin(), turned.end(), read.mesh.triangles[i][0]);
    std::rotate(turned.begin(), first, turned.end());
    CHECK(turned == read.mesh.triangles[i]);
  }
}

TEST_CASE("a picture that glTF cannot show is left out with a warning") {
  const TempFolder folder;
  MeshSinkOptions options = shown_options();
  options.pictures.load = [](std::size_t picture) {
    return picture == 0 ? png_of(gradient(4)) : "RIFF....WEBP";
  };
  for (const char* name : {"m.glb", "m.gltf"}) {
    const std::string told =
        stderr_of([&] { write_textured(folder / name, textured_square(), options); });
    CHECK(told.find("the picture bumps.jpg is left out, as glTF cannot show it: ") !=
          std::string::npos);
    const Gltf gltf(folder / name);
    CHECK(gltf.json["images"].size() == 1);
    CHECK(gltf.json["materials"][0] ==
          Json::parse(R"({"name":"front","pbrMetallicRoughness":{"baseColorTexture":{"index":0},)"
                      R"("metallicFactor":0}})"));
  }
  CHECK(files_in(folder) == 4);  // m.bin and m_atlas.png included
}

TEST_CASE("a GLB or glTF whose pictures cannot be read leaves nothing behind") {
  const TempFolder folder;
  MeshSinkOptions options = shown_options();
  int loads = 0;
  options.pictures.load = [&](std::size_t /*picture*/) -> std::string {
    if (++loads > 5) throw IoError("cannot read", "atlas.png", EIO);
    return png_of(gradient(4));
  };
  for (const char* name : {"m.glb", "m.gltf"}) {
    loads = 0;
    CHECK_THROWS_AS(write_textured(folder / name, textured_square(), options), IoError);
    CHECK(files_in(folder) == 0);
  }
  options.pictures.load = [&](std::size_t /*picture*/) {
    return png_of(gradient(4)) + std::string(static_cast<std::size_t>(++loads), 'x');
  };
  CHECK_THROWS_WITH_AS(write_textured(folder / "m.glb", textured_square(), options),
                       "maps/atlas.png: has changed while it was read", DataError);
  CHECK(files_in(folder) == 0);
}
