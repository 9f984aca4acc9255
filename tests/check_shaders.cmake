# Checks that the data flow of the kernels is visible: a function of shaders/cloth has at most six parameters, and no file
# declares a variable that functions share, besides buffers, push constants and workgroup memory.
cmake_minimum_required(VERSION 3.25)
set(sources ${CMAKE_CURRENT_LIST_DIR}/../shaders/cloth)
set(most_parameters 6)
# Feature contact keeps its piece, its response and its guard in variables of the thread.
set(variables_of_threads feature_guard.glsl feature_pieces.glsl feature_response.glsl)

file(GLOB_RECURSE files ${sources}/*.comp ${sources}/*.glsl ${sources}/*.h)
set(functions 0)
foreach(file IN LISTS files)
    get_filename_component(name ${file} NAME)
    file(READ ${file} text)
    string(REGEX REPLACE "//[^\n]*" "" text "${text}")
    string(REPLACE ";" "@" text "${text}") # a list's separator
    string(REPLACE "[" "<" text "${text}")
    string(REPLACE "]" ">" text "${text}")

    string(REGEX MATCHALL "\n[A-Za-z_0-9 ]+ [a-z_0-9]+\\([^(){}@]*\\)[ \n]*{" definitions "${text}")
    foreach(definition IN LISTS definitions)
        math(EXPR functions "${functions} + 1")
        string(REGEX REPLACE "[^,]" "" commas "${definition}")
        string(LENGTH "${commas}" count)
        if(count GREATER_EQUAL most_parameters)
            string(REGEX REPLACE "[ \n]+" " " definition "${definition}")
            math(EXPR count "${count} + 1")
            message(SEND_ERROR "${name}: ${count} parameters, more than ${most_parameters}: ${definition}")
        endif()
    endforeach()

    string(REGEX MATCHALL "\n(bool|int|uint|float|[biu]?vec[234]|mat[34]|[A-Z][A-Za-z]+) [a-z_0-9<>]+( =[^@]*)?@" variables
           "${text}")
    if(variables AND NOT name IN_LIST variables_of_threads)
        string(REGEX REPLACE "[ \n]+" " " variables "${variables}")
        message(SEND_ERROR "${name}: variables that functions share: ${variables}")
    endif()
endforeach()
if(functions LESS 200)
    message(SEND_ERROR "only ${functions} functions were found")
endif()
message(STATUS "${functions} functions checked")
