// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace meshfarm {

/// Throws IoError now rather than after an hour's work if the mesh `output` cannot be made.
void check_writable(const std::string& output);
/// The same of what is no mesh.
void check_place(const std::string& output);
/// Throws UsageError if `output`, which is given by `option`, is the file `other`, which is, in
/// words, `what`. Neither has to be there.
void check_not_over(std::string_view option, const std::string& output, std::string_view what,
                    const std::string& other);
/// The same if `output` is one of the stage's own files, or the input that the stage was cut from.
/// A stage that is not there is no error.
void check_not_of_stage(std::string_view option, const std::string& output,
                        const std::string& stage);

}  // namespace meshfarm
