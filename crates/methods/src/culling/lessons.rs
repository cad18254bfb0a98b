//! The methods of this question, explained.

use crate::lesson::Lesson;

pub(crate) const LESSONS: &[Lesson] = &[
    Lesson::new(
        "none",
        "All faces are drawn.",
        "Opaque meshes are right but cost time; transparent faces are blended in the order of the mesh.",
        "Vulkan: Basic Polygon Rasterization",
    ),
    Lesson::new(
        "back",
        "Faces that face away are culled by their winding.",
        "Right for closed meshes seen from outside. Open or mirrored meshes, and meshes seen from inside, lose parts.",
        "Foley and others 1990, Computer Graphics: Principles and Practice, 15.4",
    ),
    Lesson::new(
        "front",
        "Faces that face the viewer are culled.",
        "Right only from the inside of a closed mesh.",
        "Vulkan: Basic Polygon Rasterization",
    ),
    Lesson::new(
        "back-flipped",
        "Back faces are culled, and the front face is reversed if a transform mirrors.",
        "The application has to know which transforms mirror.",
        "OpenGL 4.6: 14.6.1",
    ),
    Lesson::new(
        "front-then-back",
        "Back faces are blended first, then front faces.",
        "The right order for one convex solid; only a good guess for several solids or hollow ones.",
        "McReynolds and Blythe 2005, Advanced Graphics Programming Using OpenGL",
    ),
    Lesson::new(
        "frustum",
        "Objects outside of the view are not drawn.",
        "Nothing is lost as long as the bounds enclose their objects.",
        "Clark 1976, Hierarchical Geometric Models for Visible Surface Algorithms",
    ),
];
