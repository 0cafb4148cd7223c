/* SPDX-License-Identifier: MIT
 * FreeType's modules for TrueType, the only fonts that a page has.
 */
FT_USE_MODULE(FT_Driver_ClassRec, tt_driver_class)
FT_USE_MODULE(FT_Module_Class, sfnt_module_class)
