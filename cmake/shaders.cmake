# splice_shaders(NAME file.vert file.frag ...): compiles shaders/glsl/FILE to SPIR-V with glslangValidator, tracks what
# they include, and embeds each as a constant array: link NAME and
# include "shaders/FILE.h" (dots become underscores), which defines `const uint32_t FILE[]`.
#
# Compute shaders go through spirv-opt: software devices make the pipelines of the large ones in half the time. Others do
# not, because passes that must agree to the last bit might be rewritten differently.
find_program(GLSLANG_VALIDATOR glslangValidator REQUIRED)
find_program(SPIRV_OPT spirv-opt REQUIRED)
function(splice_shaders name)
  set(out_dir ${CMAKE_BINARY_DIR}/shaders_generated/shaders)
  file(MAKE_DIRECTORY ${out_dir})
  set(embed ${PROJECT_SOURCE_DIR}/cmake/embed_words.cmake)
  set(headers)
  foreach(shader ${ARGN})
    string(MAKE_C_IDENTIFIER ${shader} id)
    set(source ${PROJECT_SOURCE_DIR}/shaders/glsl/${shader})
    set(header ${out_dir}/${id}.h)
    set(compile ${GLSLANG_VALIDATOR} --target-env vulkan1.2 -g0 --quiet -I${PROJECT_SOURCE_DIR}/shaders/glsl/include)
    if(shader MATCHES "\\.comp$")
      set(words ${out_dir}/${id}.spv)
      add_custom_command(OUTPUT ${words}
        COMMAND ${compile} --depfile ${words}.d -o ${words} ${source}
        DEPENDS ${source} DEPFILE ${words}.d
        COMMENT "Shader ${shader}" VERBATIM)
      add_custom_command(OUTPUT ${header}
        COMMAND ${SPIRV_OPT} -O --target-env=vulkan1.2 ${words} -o ${words}.opt
        COMMAND ${CMAKE_COMMAND} -DFROM=${words}.opt -DTO=${header} -DNAME=${id} -P ${embed}
        DEPENDS ${words} ${embed}
        COMMENT "Optimising shader ${shader}" VERBATIM)
    else()
      add_custom_command(OUTPUT ${header}
        COMMAND ${compile} --depfile ${header}.d --vn ${id} -o ${header} ${source}
        DEPENDS ${source} DEPFILE ${header}.d
        COMMENT "Shader ${shader}" VERBATIM)
    endif()
    list(APPEND headers ${header})
  endforeach()
  add_custom_target(${name}_headers DEPENDS ${headers})
  add_library(${name} INTERFACE)
  add_dependencies(${name} ${name}_headers)
  target_include_directories(${name} SYSTEM INTERFACE ${CMAKE_BINARY_DIR}/shaders_generated)
endfunction()
