// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace meshfarm {

/// Throws IoError now rather than after an hour's work if the mesh `output` cannot be created.
void check_writable(const std::string& output);
/// The same check for an output that is not a mesh.
void check_place(const std::string& output);
/// Throws UsageError if `output`, given by `option`, is the file `other`, described by `what`.
/// Neither file has to exist.
void check_not_over(std::string_view option, const std::string& output, std::string_view what,
                    const std::string& other);
/// The same if `output` is one of the stage's own files, or the input that the stage was cut from.
/// A stage that does not exist is no error.
void check_not_of_stage(std::string_view option, const std::string& output,
                        const std::string& stage);

}  // namespace meshfarm
