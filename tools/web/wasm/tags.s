# SPDX-License-Identifier: MIT
# The tags under which longjmp and C++ throw: libraries that do so name them, and no object that zig brings has them.
.globl __c_longjmp
.tagtype __c_longjmp i32
__c_longjmp:
.globl __cpp_exception
.tagtype __cpp_exception i32
__cpp_exception:
