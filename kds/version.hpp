// The version of the library, for the preprocessor: the one place where it is written.
#pragma once

// Versions with the same major and minor number are compatible; what changes is in CHANGELOG.md.
#define KDS_VERSION_MAJOR 0
#define KDS_VERSION_MINOR 1
#define KDS_VERSION_PATCH 0

/// For comparisons: 100 for 0.1.0.
#define KDS_VERSION_NUMBER (KDS_VERSION_MAJOR * 10000 + KDS_VERSION_MINOR * 100 + KDS_VERSION_PATCH)
