# SPDX-License-Identifier: Apache-2.0
# FIELDCAST_SANITIZE=address,undefined | thread applies to every target of the build.
if(FIELDCAST_SANITIZE)
    add_compile_options(-fsanitize=${FIELDCAST_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all -O1)
    add_link_options(-fsanitize=${FIELDCAST_SANITIZE})
endif()
