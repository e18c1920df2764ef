// The degrees of paths that the library is compiled for.
//
// A world is a template of the motion of its bodies (motions.hpp); broad phases, kinetic boxes and the tests of paths
// are templates of the degree of a path. All are compiled once: for straight paths and parabolas in the library
// kds::collision, for cubics, quartics and quintics (splines) in kds::collision_splines, from the same files. A program
// that links only the first has no cost from the others.
#pragma once

/// KDS_FOR_EACH_DEGREE(instantiate), in a .cpp: instantiate(degree) for the degrees of the library that is compiled.
#ifdef KDS_SPLINE_DEGREES
#define KDS_FOR_EACH_DEGREE(instantiate) instantiate(3) instantiate(4) instantiate(5)
#else
#define KDS_FOR_EACH_DEGREE(instantiate) instantiate(1) instantiate(2)
#endif

/// The same for all that a program is linked with, in a header: for `extern template`. (KDS_SPLINES is defined for all
/// that link kds::collision_splines.)
#ifdef KDS_SPLINES
#define KDS_GREATEST_DEGREE 5
#define KDS_FOR_ALL_DEGREES(declare) declare(1) declare(2) declare(3) declare(4) declare(5)
#else
#define KDS_GREATEST_DEGREE 2
#define KDS_FOR_ALL_DEGREES(declare) declare(1) declare(2)
#endif

/// KDS_TEMPLATE_PART class X<...>; instantiates a class template in each of the files that define some of its members
/// except its own, which ends in `template class X<...>;`: what is defined there. Where all of them are compiled as one
/// (KDS_PARTS_TOGETHER), its own file comes last and instantiates all.
#ifdef KDS_PARTS_TOGETHER
#define KDS_TEMPLATE_PART extern template
#else
#define KDS_TEMPLATE_PART template
#endif
