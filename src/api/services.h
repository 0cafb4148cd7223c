/* SPDX-License-Identifier: MIT
 * What the language gets from the layers below it (lang/services.h).
 */
#ifndef CSG_API_SERVICES_H
#define CSG_API_SERVICES_H

#include "lang/services.h"

const csg_services *csg_api_services(void);

#endif
