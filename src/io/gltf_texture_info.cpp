// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "gltf_texture_info.hpp"

#include <cmath>

#include <meshfarm/util/errors.hpp>

namespace meshfarm {
namespace {

constexpr std::uint64_t k_most_image_bytes = std::uint64_t{1} << 30;

/// Sine and cosine of an angle, identical on all machines.
std::array<double, 2> sine_and_cosine(double angle) {
  constexpr double k_turn = 6.283185307179586;
  // The series of a small angle, which is then doubled.
  constexpr int k_doublings = 6;
  double x = (angle - k_turn * std::floor(angle / k_turn)) / (1 << k_doublings);
  const double square = x * x;
  double sine = x * (1 - square / 6 * (1 - square / 20 * (1 - square / 42)));
  double cosine = 1 - square / 2 * (1 - square / 12 * (1 - square / 30 * (1 - square / 56)));
  for (int i = 0; i < k_doublings; ++i) {
    const double doubled = 2 * sine * cosine;
    cosine = 1 - 2 * sine * sine;
    sine = doubled;
  }
  return {sine, cosine};
}

/// The image itself, rather than those that the texture may have in other formats.
std::optional<std::uint64_t> source_of(const GltfValue& texture) {
  if (const auto source = texture.find("source")) return source->whole();
  for (const char* name :
       {"EXT_texture_webp", "KHR_texture_basisu", "EXT_texture_avif", "MSFT_texture_dds"}) {
    if (const auto other = gltf_extension(texture, name)) return other->at("source").whole();
  }
  return std::nullopt;
}

TextureWrap wrap_of(const GltfValue& sampler, const char* name) {
  constexpr std::uint64_t k_repeat = 10497;
  constexpr std::uint64_t k_clamp = 33071;
  constexpr std::uint64_t k_mirror = 33648;
  switch (sampler.whole_or(name, k_repeat)) {
    case k_repeat:
      return TextureWrap::repeat;
    case k_clamp:
      return TextureWrap::clamp;
    case k_mirror:
      return TextureWrap::mirror;
    default:
      sampler.at(name).fail("is no way to wrap");
  }
}

/// offset * rotation * scale, as in the extension's specification.
void read_transform(const GltfValue& transform, GltfTexture& made) {
  std::array<double, 2> offset{0, 0};
  std::array<double, 2> scale{1, 1};
  read_gltf_numbers(transform, "offset", offset);
  read_gltf_numbers(transform, "scale", scale);
  const std::optional<GltfValue> rotation = transform.find("rotation");
  const double angle = rotation ? rotation->real() : 0;
  if (!std::isfinite(angle)) rotation->fail("is not finite");
  const auto [sine, cosine] = sine_and_cosine(angle);
  made.a = {cosine * scale[0], sine * scale[1], offset[0]};
  made.b = {-sine * scale[0], cosine * scale[1], offset[1]};
}

}  // namespace

std::optional<GltfValue> gltf_extension(const GltfValue& value, std::string_view name) {
  const std::optional<GltfValue> extensions = value.find("extensions");
  return extensions ? extensions->find(name) : std::nullopt;
}

void read_gltf_numbers(const GltfValue& value, std::string_view name, std::span<double> numbers) {
  const std::optional<GltfValue> found = value.find(name);
  if (!found) return;
  if (found->size() < numbers.size()) found->fail("is too short");
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    numbers[i] = found->item(i).real();
    if (!std::isfinite(numbers[i])) found->fail("is not of finite numbers");
  }
}

GltfTexture read_gltf_texture(const GltfValue& document, const GltfValue& info) {
  GltfTexture made{.texture = info.at("index").whole()};
  const GltfValue texture = document.at("textures").item(made.texture);
  made.image = source_of(texture);
  if (const auto sampler = texture.find("sampler")) {
    const GltfValue wraps = document.at("samplers").item(sampler->whole());
    made.wrap_u = wrap_of(wraps, "wrapS");
    made.wrap_v = wrap_of(wraps, "wrapT");
  }
  made.set = info.whole_or("texCoord", 0);
  if (const auto transform = gltf_extension(info, "KHR_texture_transform")) {
    read_transform(*transform, made);
    made.set = transform->whole_or("texCoord", made.set);
  }
  return made;
}

std::string gltf_image_name(const GltfValue& image, std::uint64_t number) {
  const std::optional<GltfValue> uri = image.find("uri");
  const bool is_file = uri && !uri->text().starts_with("data:");
  const std::optional<GltfValue> title = image.find("name");
  if (is_file) return shown(uri->text());
  if (title && !title->text().empty()) return shown(title->text());
  return "images[" + std::to_string(number) + "]";
}

std::shared_ptr<const GltfBuffer> open_gltf_image(const GltfValue& document, GltfBuffers& buffers,
                                                  const GltfValue& image) {
  const std::optional<GltfValue> uri = image.find("uri");
  return uri ? buffers.open_uri(*uri) : buffers.open_view(document, image.at("bufferView").whole());
}

std::string read_gltf_image(const GltfBuffer& file) {
  if (file.size > k_most_image_bytes) {
    throw DataError("a picture of more than " + std::to_string(k_most_image_bytes) + " bytes");
  }
  std::string bytes(file.size, '\0');
  file.read(0, bytes);
  return bytes;
}

std::optional<GltfColumn> open_gltf_places(const GltfValue& document, GltfBuffers& buffers,
                                           const GltfValue& primitive, std::uint64_t set,
                                           std::uint64_t vertices) {
  const std::string name = "TEXCOORD_" + std::to_string(set);
  const std::optional<GltfValue> accessor = primitive.at("attributes").find(name);
  if (!accessor) return std::nullopt;
  GltfColumn made = open_column(document, accessor->whole(), buffers);
  if (made.components != 2 || made.rows != vertices) {
    throw DataError(primitive.place() + ": its texture coordinates are not of VEC2, or " +
                    "not as many as its positions");
  }
  return made;
}

}  // namespace meshfarm
