# splice_shaders(NAME file.vert file.frag ...): compiles shaders/glsl/FILE to SPIR-V with glslangValidator, tracks what
# they include, and embeds each as a constant array: link NAME and
# include "shaders/FILE.h" (dots become underscores), which defines `const uint32_t FILE[]`.
find_program(GLSLANG_VALIDATOR glslangValidator REQUIRED)
function(splice_shaders name)
  set(out_dir ${CMAKE_BINARY_DIR}/shaders_generated/shaders)
  file(MAKE_DIRECTORY ${out_dir})
  set(headers)
  foreach(shader ${ARGN})
    string(MAKE_C_IDENTIFIER ${shader} id)
    set(source ${PROJECT_SOURCE_DIR}/shaders/glsl/${shader})
    set(header ${out_dir}/${id}.h)
    add_custom_command(OUTPUT ${header}
      COMMAND ${GLSLANG_VALIDATOR} --target-env vulkan1.2 -g0 --quiet -I${PROJECT_SOURCE_DIR}/shaders/glsl/include
              --depfile ${header}.d --vn ${id} -o ${header} ${source}
      DEPENDS ${source} DEPFILE ${header}.d
      COMMENT "Shader ${shader}" VERBATIM)
    list(APPEND headers ${header})
  endforeach()
  add_custom_target(${name}_headers DEPENDS ${headers})
  add_library(${name} INTERFACE)
  add_dependencies(${name} ${name}_headers)
  target_include_directories(${name} SYSTEM INTERFACE ${CMAKE_BINARY_DIR}/shaders_generated)
endfunction()
