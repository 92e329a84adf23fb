#pragma once

namespace umov {

/// Version of the library and its commands, set by the build.
extern const char *const version;
/// Revision of the sources ("unknown" outside a git checkout), with "+" if they were changed.
extern const char *const source_revision;
/// Version of docs/conventions.md: rises whenever a sign, frame or unit of an output changes.
inline constexpr int conventions_version = 1;

} // namespace umov
