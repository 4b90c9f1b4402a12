# Warnings and sanitizers for our own code; third-party headers are SYSTEM and stay quiet.
add_library(splice_warnings INTERFACE)
target_compile_options(splice_warnings INTERFACE -Wall -Wextra -Wpedantic -Wconversion -Werror)
if(SPLICE_SANITIZE)
  # g++ 12 reports false positives inside <regex> when sanitizers are on.
  target_compile_options(splice_warnings INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  add_compile_options(-fsanitize=${SPLICE_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${SPLICE_SANITIZE})
endif()
