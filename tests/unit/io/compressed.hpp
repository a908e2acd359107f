// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include <boost/iostreams/copy.hpp>
#include <boost/iostreams/device/array.hpp>
#include <boost/iostreams/device/back_inserter.hpp>
#include <boost/iostreams/filter/gzip.hpp>
#include <boost/iostreams/filter/zstd.hpp>
#include <boost/iostreams/filtering_streambuf.hpp>

namespace meshfarm::test {

template <class Filter>
std::string compressed(std::string_view bytes) {
  namespace bio = boost::iostreams;
  std::string result;
  bio::filtering_streambuf<bio::output> out;
  out.push(Filter());
  out.push(bio::back_inserter(result));
  bio::copy(bio::array_source(bytes.data(), bytes.size()), out);
  return result;
}

inline std::string gzipped(std::string_view bytes) {
  return compressed<boost::iostreams::gzip_compressor>(bytes);
}
inline std::string zstandard(std::string_view bytes) {
  return compressed<boost::iostreams::zstd_compressor>(bytes);
}

}  // namespace meshfarm::test
