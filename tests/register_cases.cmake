# Makes tests of the cases that each subject's program has listed. ctest reads this file (tests/CMakeLists.txt).
#
# Cases of one test share a device and its pipelines, which take a software device longer to make than most cases take.
# The quick cases of a subject are one test, its other cases one for each source.
#
# A quick name without a case, and a subject without a quick name, become failing tests.
cmake_policy(VERSION 3.25)
include(${CMAKE_CURRENT_LIST_DIR}/quick_cases.cmake)

# Subjects with a process for each case: those that start programs share nothing, and the validation layer stops
# repeating messages that test_hazards causes on purpose.
set(alone_subjects ${starting_programs} test_hazards)

# Cases with a process of their own. This one sets what a device reads when it is made.
set(alone_cases_of_test_contact
    "cloth moves equally in every run where there is no room for all features, on any number of threads")

# add_cases(name label filter of doctest ...)
function(add_cases name label)
    add_test("${name}" ${programs}/${subject} ${ARGN})
    # A filter that finds no case would pass. A test is skipped if a case of it is, and the others pass.
    set_tests_properties("${name}" PROPERTIES
        LABELS "${label}" WORKING_DIRECTORY ${folder} TIMEOUT 900 FAIL_REGULAR_EXPRESSION "test cases: +0 [|]"
        SKIP_REGULAR_EXPRESSION "MESSAGE: skipped:.*test cases: +[0-9]+ [|] +[0-9]+ passed [|] 0 failed")
    if(layers AND subject IN_LIST starting_programs)
        set_tests_properties("${name}" PROPERTIES ENVIRONMENT
            "VK_ADD_LAYER_PATH=${layers};VK_INSTANCE_LAYERS=VK_LAYER_VOILE_late_pipelines")
    endif()
endfunction()

function(add_quick_problem text)
    add_test("quick_cases.cmake: ${text}" /bin/sh -c "exit 1")
    set_tests_properties("quick_cases.cmake: ${text}" PROPERTIES LABELS quick)
endfunction()

# The filter that finds these cases: doctest splits it at commas.
function(filter_of result)
    list(TRANSFORM ARGN REPLACE "," "\\\\,")
    list(JOIN ARGN "," filter)
    set(${result} "${filter}" PARENT_SCOPE)
endfunction()

# cases and sources, of each case its own: from the list that the program has written
function(read_cases)
    file(STRINGS ${folder}/cases/${subject}.xml lines REGEX "<TestCase ")
    foreach(line IN LISTS lines)
        string(REGEX MATCH " name=\"([^\"]*)\" filename=\"([^\"]*)\"" found "${line}")
        set(name "${CMAKE_MATCH_1}")
        cmake_path(GET CMAKE_MATCH_2 STEM source)
        string(REPLACE "&lt;" "<" name "${name}")
        string(REPLACE "&gt;" ">" name "${name}")
        string(REPLACE "&quot;" "\"" name "${name}")
        string(REPLACE "&amp;" "&" name "${name}")
        list(APPEND cases "${name}")
        list(APPEND sources ${source})
    endforeach()
    set(cases ${cases} PARENT_SCOPE)
    set(sources ${sources} PARENT_SCOPE)
endfunction()

function(add_each_case)
    foreach(name IN LISTS cases)
        filter_of(filter "${name}")
        set(label "")
        if(name IN_LIST quick OR NOT quick)
            set(label quick)
        endif()
        add_cases("${subject}: ${name}" "${label}" "--test-case=${filter}")
    endforeach()
endfunction()

function(add_quick_and_other_cases)
    filter_of(filter ${quick})
    add_cases("${subject}: quick cases" quick "--test-case=${filter}")
    set(alone ${alone_cases_of_${subject}})
    foreach(name IN LISTS alone)
        filter_of(filter "${name}")
        add_cases("${subject}: ${name}" "" "--test-case=${filter}")
    endforeach()
    filter_of(filter ${quick} ${alone})
    set(sources_of_others "")
    foreach(name source IN ZIP_LISTS cases sources)
        if(NOT name IN_LIST quick AND NOT name IN_LIST alone)
            list(APPEND sources_of_others ${source})
        endif()
    endforeach()
    list(REMOVE_DUPLICATES sources_of_others)
    foreach(source IN LISTS sources_of_others)
        add_cases("${subject}: ${source}" "" --source-file=*/${source}.cpp "--test-case-exclude=${filter}")
    endforeach()
endfunction()

foreach(subject IN LISTS subjects)
    if(NOT subject IN_LIST quick_subjects)
        add_quick_problem("the subject ${subject} has no quick case")
    endif()
    set(quick ${quick_cases_of_${subject}})
    set(cases "")
    set(sources "")
    if(EXISTS ${folder}/cases/${subject}.xml) # otherwise it is not built, and the test fails
        read_cases()
        foreach(name IN LISTS quick)
            if(NOT name IN_LIST cases)
                add_quick_problem("no case is named \"${subject}: ${name}\"")
            endif()
        endforeach()
    endif()
    if(subject IN_LIST alone_subjects AND cases)
        add_each_case()
    elseif(quick AND cases)
        add_quick_and_other_cases()
    else()
        add_cases("${subject}: all cases" quick)
    endif()
endforeach()
