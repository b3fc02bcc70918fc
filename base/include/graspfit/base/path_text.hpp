#pragma once

#include <string>
#include <string_view>

namespace graspfit::base {

/// Whether bytes are UTF-8 as Unicode defines it: nothing overlong, no surrogates.
bool is_utf8(std::string_view bytes);

/// A file's path as a text for JSON and other formats that hold UTF-8 only: the path itself, if it
/// is UTF-8. Paths may be any bytes, and a path that is not UTF-8 ("caf\xe9.off", from an old disk)
/// becomes "file:caf%E9.off": a percent sign and two hexadecimal digits stand for every byte but
/// letters, digits and -._~/, as in a URI. A path that begins with "file:" itself is written in the
/// same way, so that `path_of_text` gives every path back.
std::string path_text(std::string_view path);

/// The path whose `path_text` is `text`. A percent sign without two digits stands for itself.
std::string path_of_text(std::string_view text);

}  // namespace graspfit::base
