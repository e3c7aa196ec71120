// SPDX-License-Identifier: Apache-2.0
// Embree 3 or 4, whichever is installed; the builder's interface is the same.
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
