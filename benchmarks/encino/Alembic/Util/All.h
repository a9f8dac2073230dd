#pragma once
#include <Alembic/AbcGeom/All.h>
