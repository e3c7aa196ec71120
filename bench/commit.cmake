# SPDX-License-Identifier: Apache-2.0
# cmake -DSOURCE=… -DHEADER=… -P commit.cmake: writes a header with the commit that is checked out; not touched while it
# stays the same.
execute_process(COMMAND git -C ${SOURCE} describe --always --dirty --exclude=*
    OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed OR NOT commit MATCHES "^[0-9a-f]+(-dirty)?$")
    set(commit unknown)
endif()
file(CONFIGURE OUTPUT ${HEADER} CONTENT [[#pragma once
inline constexpr const char* kCommit = "@commit@";
]] @ONLY)
