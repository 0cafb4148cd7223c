/* SPDX-License-Identifier: MIT
 * What may be set in a scene, as JSON; `csgmesh params` and the live view show it.
 */
#ifndef CLI_PARAMS_JSON_H
#define CLI_PARAMS_JSON_H

#include "core/json.h"

/* The member "parameters", an array, without those under [Hidden]. */
void cli_put_params(cli_json *json, const csgm_params *params);

#endif
