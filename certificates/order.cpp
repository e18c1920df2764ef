#include "certificates/order.hpp"

namespace kds {

KDS_COMPILED_ONCE(template, certificates::Order<1>);
KDS_COMPILED_ONCE(template, certificates::Order<2>);
KDS_COMPILED_ONCE(template, certificates::Order<3>);

}  // namespace kds
